#include "sim/step_lengths.h"

#include <algorithm>

#include "sim/scene/scene_ranges.h"

namespace selvage::sim {
namespace {

// Implicit dynamics have no stable step to name the shortest collision step. In an eighth of 1/192 s cloth that moves
// at 1 m/s goes 0.65 mm, less than the thickness of the scenes' cloth (3 and 4 mm).
constexpr double kShortestImplicitShare = 1.0 / 8;

// Of the mean spring. A sheet of 24 x 24 vertices that falls at 5 m/s on the end of a rod of 8 mm has springs of
// 16, 7.3 and 2.4 times their length with a quarter, an eighth, and this; of 1.8 times in steps of 0.5 ms. Two such
// sheets that meet edge-on at 100 m/s have springs of 3.5, 3.4 and 3.1 times their length, in 1, 1.1 and 1.3 times the
// time; in steps of the dynamics of 20 times, and the fail-safe held 605 vertices.
constexpr double kSpringShare = 1.0 / 16;
constexpr double kLeastShareOfShortest = 1.0 / 64;

double mean_rest_length_m(const SpringSystem& springs) {
  double sum_m = 0;
  for (const Spring& spring : springs.springs()) sum_m += spring.rest_length_m;
  return sum_m / std::max(1.0, static_cast<double>(springs.springs().size()));
}

}  // namespace

StepLengths::StepLengths(const Scene& scene, const World& world)
    : frames_per_s_(scene.time.frames_per_s),
      longest_s_(1 / frames_per_s_),
      mean_spring_m_(mean_rest_length_m(world.springs)) {
  const bool is_implicit = scene.solver == Solver::kImplicit;
  if (is_implicit) longest_s_ = std::min(longest_s_, kLongestImplicit_s);
  longest_s_ = scene.time.max_step_s.value_or(longest_s_);
  dynamics_s_ = longest_s_;
  if (!is_implicit) dynamics_s_ = std::min(kStableShare * world.stable_step_s, 1 / frames_per_s_);
  dynamics_s_ = scene.time.dynamics_step_s.value_or(dynamics_s_);
  const double shortest_s = is_implicit ? kShortestImplicitShare * longest_s_ : dynamics_s_;
  shortest_s_ = std::min(scene.time.min_step_s.value_or(shortest_s), longest_s_);
  const double step_count_floor_s = std::min(shortest_s_, kLeastStepShare / frames_per_s_);
  least_s_ = scene.time.min_step_s ? shortest_s_ : std::max(kLeastShareOfShortest * shortest_s_, step_count_floor_s);
}

double StepLengths::shortest_s(double fastest_m_s) const {
  const double crossing_s = kSpringShare * mean_spring_m_ / fastest_m_s;  // infinite at rest
  return crossing_s < shortest_s_ ? std::max(crossing_s, least_s_) : shortest_s_;
}

StepClock StepLengths::clock() const { return StepClock(frames_per_s_, least_s_, longest_s_); }

}  // namespace selvage::sim
