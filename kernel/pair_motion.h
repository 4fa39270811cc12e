// A pair of features as one moving polygon: the differences between the corners of one and the corners of the other.
//   The features touch at t  <=>  the origin lies in the convex hull of the differences at t.
//   vf:   p - a, p - b, p - c                       (p - (wa a + wb b + wc c) = wa (p - a) + wb (p - b) + wc (p - c))
//   ee:   a - c, a - d, b - c, b - d                (hull(A) - hull(C) = hull(A - C))
//   self: p - a, p - b
// Working with differences makes every bound relative to the pair, not to its distance from the coordinate origin.
#pragma once

#include <array>

#include "kernel/vec3.h"

namespace selvage::detail {

inline constexpr int kMaxCorners = 4;

/// The polygon at one instant. `edge_u` = corner[1] - corner[0] (vf, self), corner[2] - corner[0] (ee);
/// `edge_v` = corner[2] - corner[0] (vf), corner[1] - corner[0] (ee); `edge_w` = corner[2] - corner[1] (vf).
/// Edges come from the points themselves: one rounding, relative to the edge.
struct DifferencePolygon {
  std::array<Double3, kMaxCorners> corner;
  Double3 edge_u, edge_v, edge_w;
};

struct PairMotion {
  PairKind kind = PairKind::kVf;
  int corner_count = 0;
  DifferencePolygon t0, t1;   ///< scaled by 2^-exponent
  Double3 extent;             ///< >= |corner difference| an axis over both ends, >= kExtentFloor
  int exponent = 0;           ///< the largest |component| of a corner difference is in [0.5, 1) * 2^exponent
  bool exact_scaling = true;  ///< no scaled value lost bits: a scaled zero is an exact zero
};

/// Whether all coordinates are finite and within kMaxCoordinate.
template <std::size_t N>
bool in_domain(const std::array<Double3, N>& x) {
  bool inside = true;
  for (const Double3& point : x)
    inside &=
        max_component(abs(point)) <= kMaxCoordinate && point.x == point.x && point.y == point.y && point.z == point.z;
  return inside;
}

/// The corners in the order of the public queries: {p, a, b, c}, {a, b, c, d} or {p, a, b, -}. REQUIRES in_domain().
[[nodiscard]] PairMotion make_pair_motion(PairKind kind, const std::array<Double3, 4>& x_t0,
                                          const std::array<Double3, 4>& x_t1);

/// The polygon at t, a multiple of 2^-52 in [0, 1], so that 1 - t is exact. Error: kPointRoundings.
[[nodiscard]] DifferencePolygon polygon_at(const PairMotion& motion, double t);

/// value * 2^exponent, never below the exact product.
[[nodiscard]] double scale_up(double value, int exponent);
/// value * 2^exponent, never above the exact product; value >= 0.
[[nodiscard]] double scale_down(double value, int exponent);

}  // namespace selvage::detail
