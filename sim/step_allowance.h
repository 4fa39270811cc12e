// What a step may leave behind and still be taken: collisions, strained springs, energy put into springs. What leaves
// more is tried again, with the contacts that it met or in half the time.
#pragma once

#include <cstdint>

#include "sim/collision_step.h"
#include "sim/contact/surface_parts.h"
#include "sim/scene/scene.h"
#include "sim/world.h"

namespace selvage::sim {

struct ResolvedStep;

class StepAllowance {
 public:
  /// All must outlive this; `parts` of the world's mesh.
  StepAllowance(const Scene& scene, const World& world, const SurfaceParts& parts);

  /// Of a collision step after the last run of the dynamics, where a shorter step can be tried.
  [[nodiscard]] const Patience& patience() const { return patience_; }
  /// After the runs before: another follows, and holds what was met. `halvings` as in StepClock.
  [[nodiscard]] Patience patience_before_last(std::int32_t halvings) const;
  /// Whether so few collisions were left by the repulsions that the step counts as one without (section 5: good).
  [[nodiscard]] bool is_good(const CollisionStepReport& report) const { return report.first_collisions <= few(); }
  /// Whether contact presses more springs than are borne, in a step from `x_t0` by way of the candidate to `x`.
  [[nodiscard]] bool overstrains(const Positions& x_t0, const Positions& candidate, const Positions& x,
                                 std::int32_t halvings) const;
  /// Whether a collision step put more energy than is borne into the springs of a part of the cloth. Under the explicit
  /// solver far less is borne the first time that more was met than was held (`is_new`), as another run then holds it,
  /// than where the step would have to be halved.
  [[nodiscard]] bool energizes(const ResolvedStep& step, std::span<const double> inverse_mass, double dt_s,
                               bool is_new) const;

 private:
  /// Collisions that the longest step bears in any try.
  [[nodiscard]] std::int64_t few() const;

  const Scene& scene_;
  const World& world_;
  const SurfaceParts& parts_;
  Patience patience_;
};

}  // namespace selvage::sim
