// The point of a difference polygon that is nearest to the origin: the distance of two features, the weights, and a
// direction that separates them. Computed without a proof: separation.h proves what is used.
#pragma once

#include "kernel/query/pair_motion.h"

namespace selvage::detail {

template <class Real>
struct ClosestPoint {
  /// Of the points of the pair. vf: {1, wa, wb, wc}; ee: {wa, wb, wc, wd}; self: {1, wa, wb, 0}. All >= 0; the sum over
  /// each feature is 1 up to rounding.
  std::array<double, 4> weights = {};
  Triple<Real> point;  ///< the nearest point of the polygon
  /// From the second feature to the first, the largest |component| in [0.5, 1); zero where the features meet in a
  /// corner. As good as the features allow, however near they are: the difference of two corners, the perpendicular of
  /// an edge orthogonalised against it, or the normal of the polygon.
  Triple<Real> direction;
  /// The polygon's normal on the side of the origin, in the same form; zero if the polygon has none. The better
  /// direction where the nearest point lies within rounding of the interior.
  Triple<Real> plane_normal;
};

/// Over all features: corners, edges, interior. Zero-length edges, collinear corners and parallel edges are all right.
template <class Real>
[[nodiscard]] ClosestPoint<Real> closest_point(PairKind kind, const DifferencePolygon<Real>& polygon);

extern template ClosestPoint<double> closest_point(PairKind, const DifferencePolygon<double>&);
extern template ClosestPoint<DoubleDouble> closest_point(PairKind, const DifferencePolygon<DoubleDouble>&);

/// The polygon's point for given weights, and the sums that bound its error: one weight a corner.
[[nodiscard]] std::array<double, 4> corner_weights(PairKind kind, const std::array<double, 4>& weights);

}  // namespace selvage::detail
