// Coulomb friction of a repulsion, static and kinetic (paper, 7.3).
//
// Tangential impulses on points a distance r apart exert a torque r x j, so the paper's formula turns a closed pair.
// Here the four vertices take that torque back as a rigid rotation: with Q the removal of the best-fitting rotation
// about their centre of mass, slip is measured on Q v and the impulse acts through Q^T, so the linear and the angular
// momentum of the pair are kept, and a rotating pair feels no friction. As r -> 0 this is the paper's formula.
//   Legend: w weights, m^-1 mobility, K effective mobility, r separation, y = x - centre of mass, I inertia tensor.
#pragma once

#include <optional>

#include <Eigen/Core>

#include "sim/contact/interaction.h"

namespace selvage::sim {

/// Share by which rounding may raise an energy; what would raise it by more is left out.
inline constexpr double kFrictionRounding = 0x1p-40;

struct FrictionCoefficients {
  double on_static = 0;   ///< sticks while the impulse needed is at most this times the normal impulse
  double on_kinetic = 0;  ///< slides with this times the normal impulse, never past rest
  double creep_m = 0;     ///< but with the static one where what would be left of the slip is no longer than this
};

/// How a pair slips, and what stops it: the same in all sweeps of a step.
struct SlipGeometry {
  PairVectors y = zero_vectors();  ///< from the centre of mass; this and r in lengths of their own scale
  Vec3 r = Vec3::Zero();
  Eigen::Matrix3d inverse_inertia = Eigen::Matrix3d::Zero();  ///< of a closed pair; scripted pairs do not turn freely
  Eigen::Matrix3d stop = Eigen::Matrix3d::Zero();             ///< impulse per slip, across the normal
};

/// B_i of the slip of a pair, sum of B_i u_i for displacements u_i: their relative displacement without what a rigid
/// rotation of a closed pair explains. A force f on the slip is B_i^T f on the vertices, without a torque on the pair.
[[nodiscard]] std::array<Eigen::Matrix3d, 4> slip_matrices(const Interaction& interaction, const PairVectors& x_t0);

/// What a contact has done in a step so far. Its sweeps share one cone: a slip that another contact brings back later
/// in the step is stopped by what this one has pressed before.
struct FrictionLoad {
  double pressed = 0;                  ///< sum of the changes of relative displacement along the normal, >= 0, metres
  Vec3 rubbed = Vec3::Zero();          ///< sum of the frictions, metres of relative displacement / effective mobility
  std::optional<SlipGeometry> slip{};  ///< made by the first friction
};

/// Changes of the displacements of a pair that has pressed along `normal` (unit) by load.pressed > 0; nothing where
/// nothing slips or rubs. It sticks where the sum of its frictions in the step stays within the static cone, else
/// slides on to the kinetic one. Alone it adds no energy: it removes a share in [0, 1] of the tangential slip, by a
/// projection that is orthogonal (in the masses) to the normal impulse where the points are apart along the normal.
/// Adds to load.rubbed. REQUIRES the same pair, x_t0 and normal for a load.
[[nodiscard]] std::optional<PairVectors> friction_change(const Interaction& interaction, const PairVectors& x_t0,
                                                         const PairVectors& displacement, const Vec3& normal,
                                                         const FrictionCoefficients& friction, FrictionLoad& load);

}  // namespace selvage::sim
