// Selvage's own kernel under its conformance test.
#include "fuzz/selvage-plugin.h"
#include "kernel/ccd.h"

namespace {

void answer(int32_t kind, const selvage_query* query, selvage_answer* answer) {
  std::array<selvage::Vec3, 4> x_t0, x_t1;
  for (std::size_t i = 0; i < 4; ++i) {
    x_t0[i] = {query->x_t0[i][0], query->x_t0[i][1], query->x_t0[i][2]};
    x_t1[i] = {query->x_t1[i][0], query->x_t1[i][1], query->x_t1[i][2]};
  }
  const selvage::CcdOptions options{.tolerance = 0};
  const selvage::CcdResult result =
      kind == SELVAGE_VF ? selvage::vf_ccd(x_t0, x_t1, options) : selvage::ee_ccd(x_t0, x_t1, options);
  answer->verdict = result.verdict == selvage::CcdVerdict::kSeparated ? SELVAGE_SEPARATED : SELVAGE_COLLIDES;
  answer->toi = result.toi_lower;
}

void answer_batch(int32_t kind, size_t count, const selvage_query* queries, selvage_answer* answers) {
  for (size_t i = 0; i < count; ++i) answer(kind, queries + i, answers + i);
}

}  // namespace

extern "C" const selvage_plugin* selvage_plugin_entry(void) {
  // An alarm of the kernel is within 2^-39 of the largest distance between corners (docs/guarantee-kernel.md, K3),
  // which is at most sqrt(3) sides of the box; below 2^-1071 distances are rounded out.
  static const selvage_plugin plugin = {
      SELVAGE_PLUGIN_VERSION, "selvage kernel", 0x1p-1071, 0x1p-38, 1, answer, answer_batch};
  return &plugin;
}
