#include "sim/response/friction.h"

#include <algorithm>

#include <Eigen/Geometry>

#include "sim/base/cross_matrix.h"
#include "sim/base/power_of_two.h"
#include "sim/base/pseudo_inverse.h"
#include "sim/base/share_within.h"

namespace selvage::sim {
namespace {

/// The rigid rotations of a closed pair's four vertices.
void add_rotation(const Interaction& interaction, const PairVectors& x_t0, SlipGeometry& slip) {
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
    slip.y[i] = (x_t0[i] - x_t0[0]) - center;
    largest = std::max(largest, slip.y[i].cwiseAbs().maxCoeff());
  }
  const double scale = power_of_two_above(largest);
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < 4; ++i) {
    slip.y[i] /= scale;
    inertia += (slip.y[i].squaredNorm() * Eigen::Matrix3d::Identity() - slip.y[i] * slip.y[i].transpose()) /
               interaction.mobility[i];
  }
  slip.r = relative(interaction, slip.y);
  slip.inverse_inertia = pseudo_inverse(inertia);
}

SlipGeometry make_slip_geometry(const Interaction& interaction, const PairVectors& x_t0, const Vec3& normal,
                                double mobility) {
  SlipGeometry slip;
  if (!is_closed(interaction)) {
    slip.stop = (Eigen::Matrix3d::Identity() - normal * normal.transpose()) / mobility;
    return slip;
  }
  add_rotation(interaction, x_t0, slip);
  // Where r is parallel to the normal, as of contacts that were found at the start of the step, the normal impulse
  // (7.2) and the tangential one do not feel each other. Across it an impulse turns the pair about r x t, which takes
  // its share of the mobility back.
  const Vec3 t = normal.unitOrthogonal(), s = normal.cross(t);
  const Vec3 about_t = slip.r.cross(t), about_s = slip.r.cross(s);
  const Vec3 turned_t = slip.inverse_inertia * about_t, turned_s = slip.inverse_inertia * about_s;
  Eigen::Matrix3d mobility_of_slip =
      Eigen::Vector3d(mobility - about_t.dot(turned_t), mobility - about_s.dot(turned_s), mobility).asDiagonal();
  mobility_of_slip(0, 1) = mobility_of_slip(1, 0) = -about_t.dot(turned_s);
  const Eigen::Matrix3d inverse = pseudo_inverse(mobility_of_slip);
  slip.stop =
      (inverse(0, 0) * t + inverse(0, 1) * s) * t.transpose() + (inverse(1, 0) * t + inverse(1, 1) * s) * s.transpose();
  return slip;
}

/// The relative displacement without what a rigid rotation of the pair explains.
Vec3 slip_of(const Interaction& interaction, const SlipGeometry& rotation, const PairVectors& displacement) {
  Vec3 angular_momentum = Vec3::Zero();
  if (is_closed(interaction)) {
    for (std::size_t i = 0; i < 4; ++i) {
      angular_momentum += rotation.y[i].cross(displacement[i] - displacement[0]) / interaction.mobility[i];
    }
  }
  return relative(interaction, displacement) - (rotation.inverse_inertia * angular_momentum).cross(rotation.r);
}

/// Changes of the displacements by an impulse on the slip. In real numbers their energy() is no more than the effective
/// mobility times the squared impulse, which is without the rotation.
PairVectors changes_by(const Interaction& interaction, const SlipGeometry& slip, const Vec3& impulse) {
  const Vec3 rotation_back = slip.inverse_inertia * slip.r.cross(impulse);
  PairVectors changes;
  for (std::size_t i = 0; i < 4; ++i) {
    changes[i] = interaction.mobility[i] * interaction.weights[i] * impulse - rotation_back.cross(slip.y[i]);
  }
  return changes;
}

/// Of what is missing to no slip, as far as the kinetic cone; nothing where that has been reached.
double sliding_share(const Vec3& so_far, const Vec3& to_stop, double radius) {
  const double room = radius * radius - so_far.squaredNorm();
  return room > 0 ? share_within(so_far, to_stop, room) : 0.0;
}

/// Divides by a power of two, so that momenta of displacements of any size stay finite.
double normalize(PairVectors& displacement) {
  double largest = 0;
  for (const Vec3& d : displacement) largest = std::max(largest, d.cwiseAbs().maxCoeff());
  const double scale = power_of_two_above(largest);
  for (Vec3& d : displacement) d /= scale;
  return scale;
}

/// Whether it does by more than rounding explains. In real numbers no friction does. In doubles the rotation of a
/// closed pair can, where its masses differ by more than their bits: with masses of 2^-40 to 2^40 and a friction of
/// 10^6 cloth went 10^6 m where 0.3 were wanted. REQUIRES a closed pair: in it a motion that all share does not count.
bool adds_energy(const Interaction& interaction, const PairVectors& displacement, const PairVectors& change) {
  // Beside the heaviest of n <= 4 vertices the energy is at most n + 1 times that about their centre of mass, of which
  // the heaviest alone has 1 / n of what the two frames differ by. Beside a light one it has no bound.
  std::size_t heaviest = 0;
  for (std::size_t i = 1; i < interaction.vertex_count; ++i) {
    if (interaction.mobility[i] < interaction.mobility[heaviest]) heaviest = i;
  }
  double added = 0, energy = 0;
  for (std::size_t i = 0; i < interaction.vertex_count; ++i) {
    const Vec3 own = displacement[i] - displacement[heaviest];
    added += change[i].dot(2 * own + change[i]) / interaction.mobility[i];
    energy += own.squaredNorm() / interaction.mobility[i];
  }
  return !(added <= kFrictionRounding * energy);
}

}  // namespace

std::array<Eigen::Matrix3d, 4> slip_matrices(const Interaction& interaction, const PairVectors& x_t0) {
  std::array<Eigen::Matrix3d, 4> result;
  for (std::size_t i = 0; i < 4; ++i) result[i] = interaction.weights[i] * Eigen::Matrix3d::Identity();
  if (!is_closed(interaction)) return result;
  SlipGeometry slip;
  add_rotation(interaction, x_t0, slip);
  const Eigen::Matrix3d turn = cross_matrix(slip.r) * slip.inverse_inertia;
  for (std::size_t i = 0; i < 4; ++i) result[i] += turn * cross_matrix(slip.y[i]) / interaction.mobility[i];
  return result;
}

std::optional<PairVectors> friction_change(const Interaction& interaction, const PairVectors& x_t0,
                                           const PairVectors& displacement, const Vec3& normal,
                                           const FrictionCoefficients& friction, FrictionLoad& load) {
  const double mobility = effective_mobility(interaction);
  if (!(mobility > 0) || !(load.pressed > 0) || !(friction.on_static > 0)) return std::nullopt;
  PairVectors scaled = displacement;
  const double scale = normalize(scaled);
  if (!load.slip) load.slip = make_slip_geometry(interaction, x_t0, normal, mobility);
  const SlipGeometry& slip = *load.slip;
  const Vec3 impulse_to_stop = slip.stop * -slip_of(interaction, slip, scaled);
  if (!(impulse_to_stop.norm() > 0)) return std::nullopt;
  const double normal_impulse = load.pressed / scale / mobility;
  const Vec3 so_far = load.rubbed / scale;
  const double needed = (so_far + impulse_to_stop).norm();
  const bool sticks = needed <= friction.on_static * normal_impulse;
  const bool creeps = (needed - friction.on_kinetic * normal_impulse) * mobility * scale <= friction.creep_m;
  const double most = (creeps ? friction.on_static : friction.on_kinetic) * normal_impulse;
  const double share = sticks ? 1.0 : sliding_share(so_far, impulse_to_stop, most);
  if (!(share > 0)) return std::nullopt;
  const Vec3 impulse = lever_share(interaction) * share * impulse_to_stop;
  PairVectors change = changes_by(interaction, slip, impulse);
  if (is_closed(interaction) && adds_energy(interaction, scaled, change)) return std::nullopt;
  load.rubbed += scale * impulse;
  for (Vec3& part : change) part *= scale;
  return change;
}

}  // namespace selvage::sim
