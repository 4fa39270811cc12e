#include "sim/repair/untangle.h"

#include <algorithm>
#include <iterator>

#include "kernel/assert.h"
#include "kernel/fp_env.h"
#include "sim/contact/contact_table.h"
#include "sim/repair/approach_start.h"
#include "sim/repair/body_return.h"
#include "sim/repair/draw_back.h"
#include "sim/step_input.h"

namespace selvage::sim {
namespace {

/// Of the pairs of the start: what a repair has made instead is gone with its positions.
std::vector<FacePair> still_there(std::vector<FacePair> at_start, const std::vector<FacePair>& left) {
  std::vector<FacePair> both;
  std::ranges::set_intersection(at_start, left, std::back_inserter(both));
  if (both.empty() && !left.empty()) return at_start;
  return both;
}

}  // namespace

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
  const CollisionOptions certified = step_options(options);
  SELVAGE_REQUIRE(validate_step_input(mesh, certified, V, V, bodies, kRepairStep_s) == InputError::kNone);
  SELVAGE_REQUIRE(ContactTable(mesh, certified, options.surfaces).error() == InputError::kNone);
  const SurfaceParts parts(mesh);
  CollisionBodies followed = bodies;
  followed.policy = SqueezePolicy::kStop;  // a body that waits on its way back would be left there
  UntangleState state{mesh, followed, options, find, parts, parts.cloth_flags(bodies), V, V};
  UntangleReport report;
  report.remaining = state.judge(V);
  if (!report.remaining.empty()) {
    if (draw_cloth_back(state) && return_bodies(state)) approach_start(state);
    report.remaining = still_there(report.remaining, state.judge(state.x));
  }
  report.rounds = state.rounds;
  if (!report.remaining.empty()) state.x = V;
  return {std::move(state.x), std::move(report)};
}

}  // namespace selvage::sim
