// What surfaces bring to their contacts, and what two of them have together.
#pragma once

#include <string_view>

namespace selvage::sim {

/// Of one surface, or of a pair of them.
struct ContactProperties {
  double thickness_m = 1e-3;    ///< repulsions act below it (paper, 7.2); in [0, kMaxCoordinate]
  double tolerance_m = 1e-6;    ///< distance kept at the end of every step (paper, section 6); likewise
  double friction_static = 0;   ///< Coulomb coefficient, dimensionless, >= friction_kinetic
  double friction_kinetic = 0;  ///< Coulomb coefficient, dimensionless, >= 0
  bool is_of_rest = false;  ///< of a pair alone: a rest pair's (rest_pairs.h), whose distance at rest is thickness_m

  friend bool operator==(const ContactProperties&, const ContactProperties&) = default;
};

/// Of a pair of two surfaces. Where both have the same value the pair has it, to the bit (between 1e-150 and 1e150).
///   thickness  the mean: each surface carries half of its thickness to either side;
///   tolerance  the larger, which is safe for both;
///   friction   the geometric mean, as in Box2D: between the two, and nothing grips what is frictionless.
[[nodiscard]] ContactProperties combine(const ContactProperties& a, const ContactProperties& b);

/// The name of the first value that does not lie in the range stated above; empty where all do.
[[nodiscard]] std::string_view first_bad_value(const ContactProperties& properties);
[[nodiscard]] inline bool is_valid(const ContactProperties& properties) { return first_bad_value(properties).empty(); }

}  // namespace selvage::sim
