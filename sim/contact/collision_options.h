// The numbers of a collision step.
#pragma once

#include <cstdint>

#include "sim/base/lattice.h"
#include "sim/contact/contact_properties.h"

namespace selvage::sim {

/// Thickness, tolerance and overlap fraction are the paper's by default. The first two and the friction are those of
/// the whole mesh, unless ContactSurfaces says what its parts have.
struct CollisionOptions {
  double thickness_m = 1e-3;  ///< cloth thickness h: repulsions act below it (paper, 7.2); in [0, kMaxCoordinate]
  double tolerance_m = 1e-6;  ///< distance kept at the end of every step (paper, section 6); likewise
  /// Spring constant k of the overlap repulsion; 0: the inelastic part alone. The paper has that of the stretch springs
  /// (7.2), and so have scenes where they give none.
  double repulsion_stiffness_n_m = 0;
  double overlap_fraction = 0.1;  ///< of the overlap removed a step at most (paper, 7.2), in [0, 1]
  /// An impulse of section 7.4 gives at most this share of itself in one parallel round, in (0, 1]; never more than
  /// 1 / number of pairs at a vertex, which is what keeps energy from growing. The paper names both remedies and 0.25
  /// (7.2, 7.4); with the second the first only costs rounds.
  double relaxation = 1;
  double friction_static = 0;            ///< Coulomb coefficient, dimensionless, >= friction_kinetic
  double friction_kinetic = 0;           ///< Coulomb coefficient, dimensionless, >= 0
  bool repulsion = true;                 ///< section 7.2 and 7.3 at all
  std::int32_t max_impulse_rounds = 10;  ///< rounds of section 7.4 before impact zones, >= 0
  std::int32_t max_zone_rounds = 20;     ///< rounds of section 7.5 before the fail-safe, >= 0
  using Precision = sim::Precision;
  Precision precision = Precision::kFloat64;  ///< lattice that the result lies on
  std::int32_t max_intervals = 4096;          ///< CcdOptions::max_intervals, >= 1
};

/// The part of the options that ContactSurfaces replaces.
[[nodiscard]] inline ContactProperties contact_of(const CollisionOptions& options) {
  return {options.thickness_m, options.tolerance_m, options.friction_static, options.friction_kinetic};
}

}  // namespace selvage::sim
