// The first look at a query: a direction that separates the whole motion. It must settle nearly every query, so it is a
// straight line of plain doubles, the same for all kinds of pairs.
#pragma once

#include "kernel/query/canonical_order.h"

namespace selvage::detail {

/// Corner differences at both ends, one lane each: 0-3 at t = 0, 4-7 at t = 1, scaled by 2^-exponent. Pairs with fewer
/// corners repeat some.
struct SweptCorners {
  std::array<double, 8> x, y, z;
  Double3 extent;
  int exponent;
};

/// REQUIRES coordinates within the domain.
[[nodiscard]] SweptCorners swept_corners(PairKind kind, const CanonicalOrder& order, const Vec3* x_t0,
                                         const Vec3* x_t1);

/// PROVED when true: no touch in [0,1], and at t = 1 a distance above `tolerance` (unscaled).
[[nodiscard]] bool cull(const SweptCorners& corners, double tolerance);

}  // namespace selvage::detail
