// The method as textbooks have it (bench/textbook.h), which the conformance test finds out.
#include "bench/textbook.h"

#include "fuzz/selvage-plugin.h"

namespace {

void answer(int32_t kind, const selvage_query* query, selvage_answer* answer) {
  std::array<selvage::Vec3, 4> x_t0, x_t1;
  for (std::size_t i = 0; i < 4; ++i) {
    x_t0[i] = {query->x_t0[i][0], query->x_t0[i][1], query->x_t0[i][2]};
    x_t1[i] = {query->x_t1[i][0], query->x_t1[i][1], query->x_t1[i][2]};
  }
  const selvage::bench::TextbookAnswer result =
      kind == SELVAGE_VF ? selvage::bench::textbook_vf(x_t0, x_t1) : selvage::bench::textbook_ee(x_t0, x_t1);
  answer->verdict = result.collides ? SELVAGE_COLLIDES : SELVAGE_SEPARATED;
  answer->toi = result.toi;
}

}  // namespace

extern "C" const selvage_plugin* selvage_plugin_entry(void) {
  static const selvage_plugin plugin = {
      SELVAGE_PLUGIN_VERSION, "textbook", selvage::bench::kTextbookTolerance, 0, 1, answer, nullptr};
  return &plugin;
}
