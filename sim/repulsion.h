// Repulsions: pairs nearer than the cloth's thickness stop approaching, and a spring pushes them apart (paper, 7.2).
#pragma once

#include "sim/collision_step.h"

namespace selvage::sim {

/// Changes of the relative displacement along the normal, >= 0, metres.
struct Repulsion {
  double inelastic = 0;  ///< takes away all approach; never adds energy
  double spring = 0;     ///< bounded: the pair separates by at most overlap_fraction of its overlap in the step
  [[nodiscard]] double total() const { return inelastic + spring; }
};

/// For two points `distance` apart whose relative displacement over the step has the normal component `displacement`
/// (negative: approaching). `inverse_mass_kg` is the pair's K in 1/kg: an impulse j changes the relative velocity by K
/// j. Differs from the paper's formula in the spring's limit, which there comes out twice as large for equal masses
/// (impulse m dv for two particles of mass m changes their relative velocity by 2 dv); its text asks for this one.
[[nodiscard]] Repulsion repulsion(double distance, double displacement, double inverse_mass_kg,
                                  const CollisionOptions& options, double dt_s);

}  // namespace selvage::sim
