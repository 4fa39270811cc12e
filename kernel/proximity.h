// Closest points of a vertex and a face, or of two edges, at one instant (paper, section 6), with a proven bracket.
#pragma once

#include <array>

#include "kernel/types.h"

namespace selvage {

/// The bracket is proved a posteriori, so it holds however the weights were found (docs/guarantee-kernel.md):
///   distance_upper  evaluates the witness point of `weights`, rounding included;
///   distance_lower  comes from a separating direction, rounding included; 0 when none was found.
struct Proximity {
  double distance = 0;        ///< the computed Euclidean distance, in [distance_lower, distance_upper]
  double distance_lower = 0;  ///< PROVED: the exact distance is at least this
  double distance_upper = 0;  ///< PROVED: the exact distance is at most this
  /// vf: of p, a, b, c with weights[0] = 1 and the others >= 0, sum 1. ee: of a, b (first edge), c, d (second edge),
  /// each pair >= 0 with sum 1. Up to rounding; point_error_bound says how good they are.
  std::array<double, 4> weights = {};
  /// Unit vector from the second feature (face; second edge) to the first, up to rounding. Zero only where
  /// distance_lower is 0.
  Vec3 normal = Vec3::Zero();
  /// PROVED: |(x - y) - (x* - y*)| <= this, with x, y the points of `weights`, those of each feature divided by their
  /// exact sum, and x*, y* the exact closest points. Far from the origin take differences first: sum w_j (x_j - x_0).
  /// sqrt(upper^2 - lower^2) by the projection theorem. Bounds the normal too: sin(angle) <= point_error_bound / upper.
  double point_error_bound = 0;
};

/// x = {p, a, b, c}: point p against triangle (a, b, c), which may have zero area. REQUIRES |coordinate| <=
/// kMaxCoordinate, all finite; anything else answers distance 0, bracket [0, infinity], and no weights.
[[nodiscard]] Proximity vf_proximity(const std::array<Vec3, 4>& x);
/// x = {p, a, b}: a vertex of a face against the edge (a, b) opposite to it, as a face without area.
[[nodiscard]] inline Proximity self_proximity(const std::array<Vec3, 3>& x) {
  return vf_proximity({x[0], x[1], x[2], x[2]});
}
/// x = {a, b, c, d}: edge (a, b) against edge (c, d), parallel and zero-length ones included.
[[nodiscard]] Proximity ee_proximity(const std::array<Vec3, 4>& x);
/// The query of that kind. kSelf: x = {p, a, b, anything}.
[[nodiscard]] Proximity pair_proximity(PairKind kind, const std::array<Vec3, 4>& x);

}  // namespace selvage
