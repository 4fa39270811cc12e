// The point of a difference polygon that is nearest to the origin: the distance of the two features, its weights, and
// a direction that separates them. Computed without a proof; the bounds at the end of this file prove what is used.
#pragma once

#include "kernel/pair_motion.h"

namespace selvage::detail {

struct ClosestPoint {
  /// vf: {1, wa, wb, wc}; ee: {wa, wb, wc, wd}; self: {1, wa, wb, 0}. All >= 0; each feature's sum is 1 up to rounding.
  std::array<double, 4> weights = {};
  Double3 point;      ///< the weighted sum of the corners
  Double3 direction;  ///< from the second feature to the first, largest |component| in [0.5, 1]; zero if none was found
};

/// Over all features: corners, edges, interior. Zero-length edges, collinear corners and parallel edges are all right.
[[nodiscard]] ClosestPoint closest_point(PairKind kind, const DifferencePolygon& polygon);

/// PROVED: the distance of the features is at most this. `blend_extent`: the extent where `polygon` was interpolated,
/// whose corners carry errors relative to it; zero at t = 0 and t = 1. `exact_scaling` as in PairMotion.
[[nodiscard]] double distance_upper(PairKind kind, const DifferencePolygon& polygon, const Double3& blend_extent,
                                    bool exact_scaling, const std::array<double, 4>& weights);

/// PROVED: |fl(n . x) - n . X| < support_error for every corner x at any multiple of 2^-52 in [0, 1].
/// REQUIRES |components of n| <= 1, the largest >= 0.5.
[[nodiscard]] double support_error(const Double3& n, const Double3& extent);

/// min over corners of fl(n . x).
[[nodiscard]] double least_support(int corner_count, const DifferencePolygon& polygon, const Double3& n);

/// PROVED: the distance of the features is at least this; 0 if `n` does not separate them.
[[nodiscard]] double distance_lower(int corner_count, const DifferencePolygon& polygon, const Double3& extent,
                                    const Double3& n);

/// |v|, relative error at most kNormError whatever its size.
[[nodiscard]] double norm(const Double3& v);
/// v * 2^k with the largest |component| in [0.5, 1); zero stays zero.
[[nodiscard]] Double3 normalize_exponent(const Double3& v);

}  // namespace selvage::detail
