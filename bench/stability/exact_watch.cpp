#include "bench/stability/exact_watch.h"

#include <algorithm>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "sim/base/points.h"
#include "verify/distance_check.h"

namespace selvage::bench {
namespace {

// The gap is followed down in these steps: each costs a check, the exact smallest distance of a frame many.
constexpr double kGapShrink = 0.5;

}  // namespace

ExactWatch::ExactWatch(Trial& trial, const io::Triangles& triangles, const std::vector<std::uint8_t>& face_is_body,
                       std::int64_t vertex_count, const sim::CollisionOptions& options)
    : trial_(trial),
      topology_(verify::make_topology({triangles, face_is_body}, static_cast<std::size_t>(vertex_count))),
      tolerance_m_(options.tolerance_m) {
  trial.report().vertices = vertex_count;
  trial.report().faces = static_cast<std::int64_t>(triangles.size());
  double& gap_m = trial.report().gap_at_least_m;
  gap_m = std::min(gap_m, std::max(options.thickness_m, options.tolerance_m));
}

void ExactWatch::require_free(const verify::CheckResult& result, const char* what) {
  trial_.report().pairs_examined += result.pairs.vf + result.pairs.ee + result.pairs.overlap + result.pairs.self;
  trial_.require(result.violations_total.total() == 0,
                 fmt::format("{} has {} exact violations at step {}", what, result.violations_total.total(),
                             trial_.report().steps));
}

void ExactWatch::start(const Positions& x) {
  require_free(verify::check_frame(topology_, sim::points_of(x), {}), "the start");
}

void ExactWatch::step(const Positions& x_t0, const Positions& x_t1, const sim::CollisionStepReport& report) {
  TrialReport& account = trial_.report();
  ++account.steps;
  account.steps_with_contact += report.collided() || report.repulsions > 0;
  account.steps_with_collisions += report.collided();
  account.pairs_below_tolerance += static_cast<std::int64_t>(report.below_tolerance.size());
  account.fail_safe_steps += report.fail_safe_vertices > 0;
  account.fail_safe_vertices += report.fail_safe_vertices;
  account.waiting_bodies += static_cast<std::int64_t>(report.waiting_bodies.size());
  account.cut_candidates += report.cut_candidates;
  trial_.require(report.status == sim::StepStatus::kSafe,
                 fmt::format("step {} is {}: {}", account.steps, name_of(report.status), describe(report.input_error)));
  trial_.require(x_t1.allFinite(), fmt::format("step {} ends in positions that are not finite", account.steps));
  require_free(verify::check_motion(topology_, sim::points_of(x_t0), sim::points_of(x_t1), {}), "the motion");
  require_free(verify::check_frame(topology_, sim::points_of(x_t1), {}), "the frame");
  watch_gap(x_t1, report);
}

void ExactWatch::watch_gap(const Positions& x, const sim::CollisionStepReport& report) {
  const io::Points points = sim::points_of(x);
  const auto near_pairs = [&](double distance_m) { return verify::near_pairs(topology_, points, distance_m); };
  double& gap_m = trial_.report().gap_at_least_m;
  while (gap_m > 0 && !near_pairs(gap_m).empty()) gap_m *= kGapShrink;
  if (gap_m >= tolerance_m_) return;  // no step so far has ended so near
  std::set<std::pair<PairKind, std::array<std::int32_t, 2>>> named;
  for (const Collision& pair : report.below_tolerance) named.insert({pair.kind, {pair.first, pair.second}});
  for (const verify::Violation& near : near_pairs(tolerance_m_)) {
    const PairKind kind = near.event == verify::EventKind::kVf ? PairKind::kVf : PairKind::kEe;
    trial_.require(named.contains({kind, near.features}),
                   fmt::format("step {} ends with a pair below the tolerance that its report does not name",
                               trial_.report().steps));
  }
}

}  // namespace selvage::bench
