// What a collision step is asked for: its numbers, and which vertices are cloth, bodies and pins.
#pragma once

#include <cstdint>
#include <limits>
#include <span>

#include "sim/contact/contact_properties.h"

namespace selvage::sim {

/// Defaults are the paper's numbers, except for `relaxation`. The first two and the friction are those of the whole
/// mesh, unless ContactSurfaces says what its parts have.
struct CollisionOptions {
  double thickness_m = 1e-3;           ///< cloth thickness h: repulsions act below it (paper, 7.2); in [0, kMaxCoordinate]
  double tolerance_m = 1e-6;           ///< distance kept at the end of every step (paper, section 6); likewise
  double repulsion_stiffness_n_m = 0;  ///< spring constant k of the overlap repulsion; 0: the inelastic part alone
  double overlap_fraction = 0.1;       ///< of the overlap removed a step at most (paper, 7.2), in [0, 1]
  /// An impulse of section 7.4 gives at most this share of itself in one parallel round, in (0, 1]; never more than
  /// 1 / number of pairs at a vertex, which is what keeps energy from growing. The paper names both remedies and 0.25
  /// (7.2, 7.4); with the second the first only costs rounds.
  double relaxation = 1;
  double friction_static = 0;            ///< Coulomb coefficient, dimensionless, >= friction_kinetic
  double friction_kinetic = 0;           ///< Coulomb coefficient, dimensionless, >= 0
  bool repulsion = true;                 ///< section 7.2 and 7.3 at all
  std::int32_t impulse_iterations = 10;  ///< rounds of section 7.4 before impact zones, >= 0
  std::int32_t zone_iterations = 20;     ///< rounds of section 7.5 before the fail-safe, >= 0
  enum class Precision { kFloat64, kFloat32 } precision = Precision::kFloat64;  ///< lattice that the result lies on
  std::int32_t max_intervals = 4096;                                            ///< CcdOptions::max_intervals, >= 1
};

/// The part of the options that ContactSurfaces replaces.
[[nodiscard]] inline ContactProperties contact_of(const CollisionOptions& options) {
  return {options.thickness_m, options.tolerance_m, options.friction_static, options.friction_kinetic};
}

/// What to do where cloth cannot avoid scripted bodies (S4).
enum class SqueezePolicy : std::uint8_t {
  kStop,   ///< return kStopped with a witness; nothing is advanced
  kYield,  ///< the bodies involved wait, or the vertices involved of those that deform: they keep their positions for
           ///< this step
};

struct CollisionBodies {
  /// #V: inverse masses in 1/kg; 0 for scripted vertices, which follow their candidate positions exactly.
  std::span<const double> inverse_mass;
  /// #V: body that a scripted vertex belongs to, -1 for cloth. A body moves, or waits, as a whole. Empty: no bodies.
  std::span<const std::int32_t> body = {};
  SqueezePolicy policy = SqueezePolicy::kStop;
  /// The bodies from this one on are pins: what they hold is cloth, even a part of the mesh of which they hold all.
  std::int32_t first_pin = std::numeric_limits<std::int32_t>::max();
  /// By body, shorter where the others do not: 1 where its motion is no rigid one. It waits vertex by vertex, and cloth
  /// that has to move with it moves with what it meets.
  std::span<const std::uint8_t> deforms = {};
};

}  // namespace selvage::sim
