// Coulomb friction of a repulsion, static and kinetic (paper, 7.3).
//
// Tangential impulses on points a distance r apart exert a torque r x j, so the paper's formula turns a closed pair.
// Here the four vertices take that torque back as a rigid rotation: with Q the removal of the best-fitting rotation
// about their centre of mass, slip is measured on Q v and the impulse acts through Q^T, so the linear and the angular
// momentum of the pair are kept, and a rotating pair feels no friction. As r -> 0 this is the paper's formula.
//   Legend: w weights, m^-1 mobility, K effective mobility, r separation, y = x - centre of mass, I inertia tensor.
#pragma once

#include <optional>

#include "sim/interaction.h"

namespace selvage::sim {

struct FrictionCoefficients {
  double on_static = 0;   ///< sticks while the impulse needed is at most this times the normal impulse
  double on_kinetic = 0;  ///< slides with this times the normal impulse, never past rest
};

/// Changes of the displacements of a pair that repels along `normal` (unit) by `normal_change` > 0 of relative
/// displacement; nothing where nothing slips or rubs. Alone it adds no energy: it removes a share in [0, 1] of the
/// tangential slip, by a projection orthogonal (in the masses) to the normal impulse.
[[nodiscard]] std::optional<PairVectors> friction_change(const Interaction& interaction, const PairVectors& x_t0,
                                                         const PairVectors& displacement, const Vec3& normal,
                                                         double normal_change, const FrictionCoefficients& friction);

}  // namespace selvage::sim
