#include "sim/friction.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "sim/power_of_two.h"
#include "sim/pseudo_inverse.h"

namespace selvage::sim {
namespace {

/// The rigid rotations of a closed pair's four vertices, in lengths of `scale`; scripted pairs have none.
struct PairRotation {
  PairVectors y = zero_vectors();  ///< from the centre of mass
  Vec3 r = Vec3::Zero();
  Eigen::Matrix3d inverse_inertia = Eigen::Matrix3d::Zero();
};

PairRotation pair_rotation(const Interaction& interaction, const PairVectors& x_t0) {
  PairRotation result;
  if (!is_closed(interaction)) return result;
  double mass_sum = 0;
  Vec3 center = Vec3::Zero();  // relative to the first vertex
  for (std::size_t i = 0; i < 4; ++i) {
    const double mass = 1 / interaction.mobility[i];
    mass_sum += mass;
    center += mass * (x_t0[i] - x_t0[0]);
  }
  center /= mass_sum;
  double largest = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    result.y[i] = (x_t0[i] - x_t0[0]) - center;
    largest = std::max(largest, result.y[i].cwiseAbs().maxCoeff());
  }
  const double scale = power_of_two_above(largest);
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < 4; ++i) {
    result.y[i] /= scale;
    inertia += (result.y[i].squaredNorm() * Eigen::Matrix3d::Identity() - result.y[i] * result.y[i].transpose()) /
               interaction.mobility[i];
  }
  result.r = relative(interaction, result.y);
  result.inverse_inertia = pseudo_inverse(inertia);
  return result;
}

/// The relative displacement without what a rigid rotation of the pair explains.
Vec3 slip_of(const Interaction& interaction, const PairRotation& rotation, const PairVectors& displacement) {
  Vec3 angular_momentum = Vec3::Zero();
  if (is_closed(interaction)) {
    for (std::size_t i = 0; i < 4; ++i) {
      angular_momentum += rotation.y[i].cross(displacement[i] - displacement[0]) / interaction.mobility[i];
    }
  }
  return relative(interaction, displacement) - (rotation.inverse_inertia * angular_momentum).cross(rotation.r);
}

/// Divides by a power of two, so that momenta of displacements of any size stay finite.
double normalize(PairVectors& displacement) {
  double largest = 0;
  for (const Vec3& d : displacement) largest = std::max(largest, d.cwiseAbs().maxCoeff());
  const double scale = power_of_two_above(largest);
  for (Vec3& d : displacement) d /= scale;
  return scale;
}

}  // namespace

std::optional<PairVectors> friction_change(const Interaction& interaction, const PairVectors& x_t0,
                                           const PairVectors& displacement, const Vec3& normal, double normal_change,
                                           const FrictionCoefficients& friction) {
  const double mobility = effective_mobility(interaction);
  if (!(mobility > 0) || !(normal_change > 0) || !(friction.on_static > 0)) return std::nullopt;
  PairVectors scaled = displacement;
  const double scale = normalize(scaled);
  const PairRotation rotation = pair_rotation(interaction, x_t0);
  const Eigen::Matrix3d tangential = Eigen::Matrix3d::Identity() - normal * normal.transpose();
  const Eigen::Matrix3d r_cross = cross_matrix(rotation.r);
  // r is parallel to the normal, so the normal impulse (7.2) and the tangential one do not feel each other.
  const Eigen::Matrix3d mobility_of_slip =
      tangential * (mobility * Eigen::Matrix3d::Identity() + r_cross * rotation.inverse_inertia * r_cross) * tangential;
  const Vec3 slip = tangential * slip_of(interaction, rotation, scaled);
  const Vec3 impulse_to_stop = pseudo_inverse(mobility_of_slip) * -slip;

  const double needed = impulse_to_stop.norm();
  if (!(needed > 0)) return std::nullopt;
  const double normal_impulse = normal_change / scale / mobility;
  const bool sticks = needed <= friction.on_static * normal_impulse;
  const double share = sticks ? 1.0 : std::min(friction.on_kinetic * normal_impulse / needed, 1.0);
  if (!(share > 0)) return std::nullopt;
  const Vec3 impulse = lever_share(interaction) * share * impulse_to_stop;
  const Vec3 rotation_back = rotation.inverse_inertia * rotation.r.cross(impulse);
  PairVectors change;
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3 straight = interaction.mobility[i] * interaction.weights[i] * impulse;
    change[i] = scale * (straight - rotation_back.cross(rotation.y[i]));
  }
  return change;
}

}  // namespace selvage::sim
