// Momenta and energy of point masses, and random pairs, for the tests of responses.
#pragma once

#include <span>
#include <vector>

#include <Eigen/Geometry>
#include <rapidcheck.h>

#include "sim/contact/interaction.h"
#include "sim/contact/repulsion_contact.h"

namespace selvage::sim::testbed {

struct Mechanics {
  Vec3 linear = Vec3::Zero(), angular = Vec3::Zero();
  double energy = 0;
  double linear_scale = 0, angular_scale = 0;  ///< sums of magnitudes: what rounding is relative to
};

/// Of nodes at x with velocities v; the angular momentum is about the origin. Nodes without mobility have no part.
inline Mechanics mechanics(std::span<const Vec3> x, std::span<const Vec3> v, std::span<const double> inverse_mass) {
  Mechanics result;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!(inverse_mass[i] > 0)) continue;
    const double mass = 1 / inverse_mass[i];
    result.linear += mass * v[i];
    result.angular += mass * x[i].cross(v[i]);
    result.energy += mass * v[i].squaredNorm() / 2;
    result.linear_scale += mass * v[i].norm();
    result.angular_scale += mass * x[i].norm() * v[i].norm();
  }
  return result;
}

/// In [begin, end), over the whole range from the first case on: RapidCheck would start small.
inline int integer_in(int begin, int end) { return *rc::gen::resize(rc::kNominalSize, rc::gen::inRange(begin, end)); }
inline double number_between(double lower, double upper) {
  const int k = integer_in(0, 1 << 20);
  return lower + (upper - lower) * k / (1 << 20);
}
inline Vec3 vector_within(double bound) {
  return {number_between(-bound, bound), number_between(-bound, bound), number_between(-bound, bound)};
}

/// A vertex-face or an edge-edge pair with random weights, positions, displacements and masses from 1/100 to 100 kg.
struct RandomPair {
  Interaction interaction;
  PairVectors x_t0, displacement;
  std::array<double, 4> inverse_mass;
};
inline RandomPair random_pair(bool with_scripted) {
  RandomPair pair;
  const PairKind kind = integer_in(0, 2) == 0 ? PairKind::kVf : PairKind::kEe;
  std::array<double, 4> weights;
  if (kind == PairKind::kVf) {
    const double a = number_between(0, 1);
    const double b = number_between(0, 1 - a);
    weights = {1, a, b, 1 - a - b};
  } else {
    const double a = number_between(0, 1);
    const double b = number_between(0, 1);
    weights = {1 - a, a, 1 - b, b};
  }
  for (std::size_t i = 0; i < 4; ++i) {
    pair.x_t0[i] = vector_within(1);
    pair.displacement[i] = vector_within(1);
    pair.inverse_mass[i] = std::exp2(number_between(-6.6, 6.6));
    if (with_scripted && integer_in(0, 3) == 0) pair.inverse_mass[i] = 0;
  }
  pair.interaction = make_interaction(kind, {0, 1, 2, 3}, weights, pair.inverse_mass);
  return pair;
}

/// As random_pair(false), but `gap` apart along the z axis, which becomes the normal.
inline RandomPair random_contact(double gap) {
  RandomPair pair = random_pair(false);
  for (Vec3& x : pair.x_t0) x.z() = 0;
  const Vec3 miss = relative(pair.interaction, pair.x_t0);
  const std::size_t first = pair.interaction.weights[1] > 0 ? 2 : 1;  // vertices of the first feature
  for (std::size_t i = 0; i < first; ++i) pair.x_t0[i] -= miss - gap * Vec3::UnitZ();
  return pair;
}

/// They differ by more than doubles hold.
inline RandomPair contact_of_extreme_masses() {
  RandomPair pair = random_contact(0.1);
  std::array<double, 4> inverse_mass{};
  for (double& w : inverse_mass) w = std::exp2(number_between(-49, 49));
  std::array<double, 4> weights = pair.interaction.weights;
  const PairKind kind = weights[1] > 0 ? PairKind::kEe : PairKind::kVf;
  for (double& w : weights) w = std::abs(w);
  pair.interaction = make_interaction(kind, {0, 1, 2, 3}, weights, inverse_mass);
  return pair;
}

/// The contact of a pair where it is, along the line between its points.
inline RepulsionContact contact_of(const RandomPair& pair, double thickness_m) {
  RepulsionContact contact;
  contact.kind = pair.interaction.weights[1] > 0 ? PairKind::kEe : PairKind::kVf;
  contact.interaction = pair.interaction;
  contact.x_t0 = pair.x_t0;
  contact.normal = relative(pair.interaction, pair.x_t0).normalized();
  contact.distance = relative(pair.interaction, pair.x_t0).norm();
  contact.mobility = effective_mobility(pair.interaction);
  contact.properties.thickness_m = thickness_m;
  return contact;
}

inline PairVectors sum(const PairVectors& a, const PairVectors& b, double factor = 1) {
  PairVectors result;
  for (std::size_t i = 0; i < 4; ++i) result[i] = a[i] + factor * b[i];
  return result;
}

}  // namespace selvage::sim::testbed
