// Crumpled sheets with unequal masses, for the properties of forces and limits: same bits for the same seed.
#pragma once

#include <random>
#include <vector>

#include <Eigen/Geometry>

#include "sim/cloth.h"

namespace selvage::testing {

struct RandomCloth {
  sim::SpringSystem springs;
  std::vector<double> inverse_mass;
  Positions x, v;
};

/// A sheet of side 1 m with every vertex moved by up to `crumple` times the spacing, velocities of about 1 m/s, and
/// masses that differ by up to a factor of 9.
inline RandomCloth random_cloth(std::uint32_t seed, std::int32_t side = 9, double crumple = 1.0 / 3) {
  std::mt19937 generator(seed);
  const auto uniform = [&](double lower, double upper) {
    return lower + (upper - lower) * (double(generator()) * 0x1p-32);
  };
  sim::ClothSpec spec;
  spec.surface = sim::SheetSpec{side, side, 1, 1};
  spec.stretch_n_m = 50;
  spec.shear_n_m = 20;
  spec.bend_n_m = 0.5;
  spec.damping_ratio = 0.1;
  const sim::Shape rest = sim::make_sheet(side, side, 1, 1);
  std::vector<double> mass_kg(static_cast<std::size_t>(rest.x.rows()));
  for (double& mass : mass_kg) mass = 1e-3 * uniform(1, 9);
  RandomCloth cloth{{sim::make_springs(spec, rest, mass_kg), static_cast<std::int32_t>(rest.x.rows())}, {}, rest.x, {}};
  for (const double mass : mass_kg) cloth.inverse_mass.push_back(1 / mass);
  cloth.v.resize(rest.x.rows(), 3);
  const double reach = crumple / (side - 1);
  for (Eigen::Index i = 0; i < cloth.x.rows(); ++i) {
    for (Eigen::Index k = 0; k < 3; ++k) {
      cloth.x(i, k) += uniform(-reach, reach);
      cloth.v(i, k) = uniform(-1, 1);
    }
  }
  return cloth;
}

/// What keeps the same sheet flat, all alike.
inline std::vector<sim::Stabilizer> sheet_stabilizers(std::int32_t side, double stiffness_n_m, double damping_n_s_m) {
  sim::ClothSpec spec;
  spec.surface = sim::SheetSpec{side, side, 1, 1};
  spec.stabilize_n_m = 1;
  const sim::Shape rest = sim::make_sheet(side, side, 1, 1);
  auto made = sim::make_stabilizers(spec, rest, std::vector<double>(static_cast<std::size_t>(rest.x.rows()), 1));
  for (sim::Stabilizer& s : made) {
    s.stiffness_n_m = stiffness_n_m;
    s.damping_n_s_m = damping_n_s_m;
  }
  return made;
}

inline Vec3 linear_momentum(const RandomCloth& cloth, const Positions& v) {
  Vec3 sum = Vec3::Zero();
  for (Eigen::Index i = 0; i < v.rows(); ++i) {
    sum += v.row(i).transpose() / cloth.inverse_mass[static_cast<std::size_t>(i)];
  }
  return sum;
}

inline Vec3 angular_momentum(const RandomCloth& cloth, const Positions& v) {
  Vec3 sum = Vec3::Zero();
  for (Eigen::Index i = 0; i < v.rows(); ++i) {
    const Vec3 arm = cloth.x.row(i), velocity = v.row(i);
    sum += arm.cross(velocity) / cloth.inverse_mass[static_cast<std::size_t>(i)];
  }
  return sum;
}

inline double kinetic_energy(const RandomCloth& cloth, const Positions& v) {
  double sum = 0;
  for (Eigen::Index i = 0; i < v.rows(); ++i) {
    sum += v.row(i).squaredNorm() / 2 / cloth.inverse_mass[static_cast<std::size_t>(i)];
  }
  return sum;
}

}  // namespace selvage::testing
