#include "sim/repair/untangle.h"

#include <algorithm>

#include "kernel/assert.h"
#include "kernel/fp_env.h"
#include "sim/repair/body_return.h"
#include "sim/repair/membrane.h"

namespace selvage::sim {

CollisionOptions step_options(const UntangleOptions& options) {
  CollisionOptions result;
  result.thickness_m = options.gap_m;
  result.tolerance_m = options.tolerance_m;
  result.precision = options.precision;
  return result;
}

UntangleResult untangle(const Mesh& mesh, const PositionsRef& V, const CollisionBodies& bodies,
                        const UntangleOptions& options, const FindIntersections& find) {
  const FpEnvGuard guard;
  SELVAGE_REQUIRE(options.gap_m > 0);
  const SurfaceParts parts(mesh);
  UntangleState state{mesh, bodies, options, find, parts, parts.cloth_flags(bodies), V, V};
  UntangleReport report;
  report.before = report.remaining = state.judge(state.x);
  if (!report.before.empty()) {
    if (draw_cloth_back(state) && return_bodies(state)) approach_start(state);
    report.remaining = state.judge(state.x);
  }
  report.rounds = state.rounds;
  if (!report.remaining.empty()) state.x = V;
  for (Eigen::Index v = 0; v < V.rows(); ++v) {
    const double moved_m = (state.x.row(v) - V.row(v)).stableNorm();
    report.moved_vertices += moved_m > 0 ? 1 : 0;
    report.largest_move_m = std::max(report.largest_move_m, moved_m);
  }
  return {std::move(state.x), std::move(report)};
}

}  // namespace selvage::sim
