// Lets strained cloth come to rest before it is simulated: a repair of the start (untangle.h) may leave springs of
// several times their length, or of a hundredth of it, and cloth that starts with them flies apart.
#pragma once

#include <cstdint>

#include "sim/collision_step.h"
#include "sim/springs/spring.h"
#include "sim/springs/stabilizer.h"

namespace selvage::sim {

struct RelaxedSprings {
  Positions x;                ///< #V by 3
  std::int32_t steps = 0;     ///< that led there; 0: x is what it was
  double largest_strain = 0;  ///< there (spring_strain.h)
};

/// Certified steps from rest, each as far as the springs alone draw the cloth in 1/120 s (ImplicitDynamics), until no
/// structural or shear spring is longer or shorter by more than `strain_limit` of its length at rest, or the sum of
/// what is beyond that falls no more, or after kMaxRelaxSteps: the step at which that sum was least. Where vertices
/// with inverse mass 0 hold the cloth, which stay, the longest of its springs may grow meanwhile. PRE and POST: x is
/// free of intersections, as for CollisionStep. `stabilizers` may be null. Deterministic for any number of threads.
[[nodiscard]] RelaxedSprings relax_springs(const Positions& x, const SpringSystem& springs,
                                           const StabilizerSystem* stabilizers, CollisionStep& collision_step,
                                           const CollisionBodies& bodies, double strain_limit);

inline constexpr std::int32_t kMaxRelaxSteps = 100;

}  // namespace selvage::sim
