// A pair of features as one moving polygon: the differences between the corners of one and the corners of the other.
//   The features touch at t  <=>  the origin lies in the convex hull of the differences at t.
//   vf:   p - a, p - b, p - c                       (p - (wa a + wb b + wc c) = wa (p - a) + wb (p - b) + wc (p - c))
//   ee:   a - c, a - d, b - c, b - d                (hull(A) - hull(C) = hull(A - C))
//   self: p - a, p - b
// Working with differences makes every bound relative to the pair, not to its distance from the coordinate origin.
#pragma once

#include <array>

#include "kernel/arithmetic/vec3.h"

namespace selvage::detail {

/// The points of a pair at one instant in query order: {p, a, b, c}, {a, b, c, d}, or {p, a, b, unused}.
using PairPoints = std::array<Double3, 4>;

/// The polygon at one instant. `edge_u` = corner[1] - corner[0] (vf, self), corner[2] - corner[0] (ee);
/// `edge_v` = corner[2] - corner[0] (vf), corner[1] - corner[0] (ee); `edge_w` = corner[2] - corner[1] (vf).
/// Edges come from the points themselves: one rounding, relative to the edge.
template <class Real>
struct DifferencePolygon {
  std::array<Triple<Real>, 4> corner;
  Triple<Real> edge_u, edge_v, edge_w;
};

constexpr int corner_count(PairKind kind) { return kind == PairKind::kVf ? 3 : kind == PairKind::kEe ? 4 : 2; }

template <class Real>
struct PairMotion {
  PairKind kind = PairKind::kVf;
  DifferencePolygon<Real> t0, t1;  ///< scaled by 2^-exponent
  Double3 extent;                  ///< >= |corner difference| along each axis, over both ends
  Double3 edge_extent;             ///< >= |edge| along each axis, over all edges and both ends
  int exponent = 0;                ///< the largest |component| of a corner difference is in [0.5, 1) * 2^exponent
  bool exact_scaling = true;       ///< no value lost bits to underflow: a scaled zero is an exact zero
};

/// Double differences carry one rounding each, DoubleDouble ones none. REQUIRES coordinates within the domain.
template <class Real>
[[nodiscard]] PairMotion<Real> make_pair_motion(PairKind kind, const PairPoints& x_t0, const PairPoints& x_t1);

/// The polygon at t, with t and s = 1 - t both exact. Error: kPointRoundings (rounding.h).
template <class Real>
[[nodiscard]] DifferencePolygon<Real> polygon_at(const PairMotion<Real>& motion, const Real& s, const Real& t);

extern template PairMotion<double> make_pair_motion(PairKind, const PairPoints&, const PairPoints&);
extern template PairMotion<DoubleDouble> make_pair_motion(PairKind, const PairPoints&, const PairPoints&);
extern template DifferencePolygon<double> polygon_at(const PairMotion<double>&, const double&, const double&);
extern template DifferencePolygon<DoubleDouble> polygon_at(const PairMotion<DoubleDouble>&, const DoubleDouble&,
                                                           const DoubleDouble&);

}  // namespace selvage::detail
