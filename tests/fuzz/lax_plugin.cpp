// A plugin that is right but for this: it calls collisions what ends within 1.25 times the gap that it declares.
#include "fuzz/selvage-plugin.h"
#include "kernel/ccd.h"

namespace {

constexpr double kDeclared = 1e-5;

void answer(int32_t kind, const selvage_query* query, selvage_answer* answer) {
  std::array<selvage::Vec3, 4> x_t0, x_t1;
  for (std::size_t i = 0; i < 4; ++i) {
    x_t0[i] = {query->x_t0[i][0], query->x_t0[i][1], query->x_t0[i][2]};
    x_t1[i] = {query->x_t1[i][0], query->x_t1[i][1], query->x_t1[i][2]};
  }
  const selvage::CcdOptions options{.tolerance = 1.25 * kDeclared};
  const selvage::CcdResult result =
      kind == SELVAGE_VF ? selvage::vf_ccd(x_t0, x_t1, options) : selvage::ee_ccd(x_t0, x_t1, options);
  answer->verdict = result.verdict == selvage::CcdVerdict::kSeparated ? SELVAGE_SEPARATED : SELVAGE_COLLIDES;
}

}  // namespace

extern "C" const selvage_plugin* selvage_plugin_entry(void) {
  static const selvage_plugin plugin = {SELVAGE_PLUGIN_VERSION, "lax", kDeclared, 0x1p-38, 0, answer, nullptr};
  return &plugin;
}
