// Gaps between two point sets along a direction, as proved lower bounds: the tool of the checker's filters.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "verify/arithmetic/point.h"

namespace selvage::verify {

inline Point difference(const Point& a, const Point& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

inline Point cross(const Point& a, const Point& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

inline double dot(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// Points as differences from one origin, so that rounding is relative to the size of the pair, not to its place.
template <std::size_t N>
struct Local {
  std::array<Point, N> points;
  Point magnitude{};  // per axis, of the largest |point|

  Local(const Point& origin, const std::array<Point, N>& world) {
    for (std::size_t i = 0; i < N; ++i) {
      points[i] = difference(world[i], origin);
      for (std::size_t k = 0; k < 3; ++k) magnitude[k] = std::max(magnitude[k], std::abs(points[i][k]));
    }
  }
};

/// What is proved about two point sets along a direction: min(u . p) - max(u . q) >= forward, over all p and q, and
/// min(u . q) - max(u . p) >= backward.
struct Gaps {
  double forward, backward;
};

/// u is taken as it is, exactly.
/// Computed u . x errs by at most gamma(4) sum |u_k x_k| + 3 * 2^-1075: one rounding of the difference, one of the
/// product, two of the sum; three products may underflow. Twice that (p and q), the roundings of the magnitude and of
/// the two subtractions below stay under 2^-49 sum |u_k| m_k + 2^-1070. A difference that overflowed, or a NaN in u,
/// makes the magnitude infinite or NaN, and the answers minus infinity or NaN: no comparison with them succeeds.
template <std::size_t N, std::size_t M>
inline Gaps gaps(const Point& u, const Local<N>& p, const Local<M>& q) {
  double p_low = dot(u, p.points[0]), q_low = dot(u, q.points[0]), p_high = p_low, q_high = q_low, magnitude = 0;
  for (std::size_t i = 1; i < N; ++i) {
    const double value = dot(u, p.points[i]);
    p_low = std::min(p_low, value);
    p_high = std::max(p_high, value);
  }
  for (std::size_t i = 1; i < M; ++i) {
    const double value = dot(u, q.points[i]);
    q_low = std::min(q_low, value);
    q_high = std::max(q_high, value);
  }
  for (std::size_t k = 0; k < 3; ++k) magnitude += std::abs(u[k]) * std::max(p.magnitude[k], q.magnitude[k]);
  const double margin = 0x1p-49 * magnitude + 0x1p-1070;
  return {(p_low - q_high) - margin, (q_low - p_high) - margin};
}

}  // namespace selvage::verify
