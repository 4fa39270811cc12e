// How long the steps of a scene may be: of the dynamics, and of the collision step (paper, section 5).
#pragma once

#include "sim/scene/scene.h"
#include "sim/step_clock.h"
#include "sim/world.h"

namespace selvage::sim {

/// Of stable_step_s(), where no dynamics step is given. Springs that are compressed or turn within the step are not in
/// its bound; nine tenths was stable in every scene tried. Where contact holds stretched cloth steps are shorter
/// (central_differences.cpp).
inline constexpr double kStableShare = 0.9;

class StepLengths {
 public:
  StepLengths(const Scene& scene, const World& world);

  /// s; of the dynamics. A collision step that is longer holds several.
  [[nodiscard]] double dynamics_s() const { return dynamics_s_; }
  /// s; of the collision step where no contact meets at more than this, m/s >= 0: what the scene says, else the
  /// dynamics' step (paper, section 5), or a part of the longest where the dynamics are implicit. But where the scene
  /// does not say, no longer than it takes for a sixteenth of a spring, down to a 64th of that: what meets at 100 m/s
  /// goes six edges in a step of the dynamics, which no response resolves (docs/measurements/stability.md). A step is
  /// halved where half of it is no shorter than this, so it can be up to twice as long.
  [[nodiscard]] double shortest_s(double fastest_m_s) const;
  /// With room for the shortest of all.
  [[nodiscard]] StepClock clock() const;

 private:
  double frames_per_s_, longest_s_, dynamics_s_, shortest_s_;
  double least_s_;        ///< for any speed
  double mean_spring_m_;  ///< rest length
};

}  // namespace selvage::sim
