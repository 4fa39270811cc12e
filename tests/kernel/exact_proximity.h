// The closest point of a difference polygon, exactly: every feature tried, the best kept.
#pragma once

#include "tests/kernel/exact.h"

namespace selvage::testing {

class ExactClosest {
 public:
  /// x as in vf_proximity, ee_proximity, or {p, a, b, unused}.
  ExactClosest(PairKind kind, const std::array<Rational3, 4>& x) : corners_(exact_corners(kind, x)) {
    for (const Rational3& corner : corners_) consider(corner);
    if (kind == PairKind::kEe) {
      for (const auto& [i, j] : {std::pair{0, 1}, {2, 3}, {0, 2}, {1, 3}}) consider_edge(i, j);
    } else {
      for (const auto& [i, j] : {std::pair{0, 1}, {0, 2}, {1, 2}}) consider_edge(i, j);
    }
    if (kind != PairKind::kSelf) consider_interior(kind);
  }

  [[nodiscard]] const Rational3& point() const { return best_; }
  [[nodiscard]] const Rational& distance_squared() const { return best_squared_; }

 private:
  void consider(const Rational3& candidate) {
    const Rational squared = dot(candidate, candidate);
    if (!found_ || squared < best_squared_) {
      best_ = candidate;
      best_squared_ = squared;
      found_ = true;
    }
  }

  void consider_edge(int i, int j) {
    const Rational3 &p = corners_[static_cast<std::size_t>(i)], edge = corners_[static_cast<std::size_t>(j)] - p;
    const Rational length_squared = dot(edge, edge);
    if (length_squared == 0) return;
    const Rational t = -dot(p, edge) / length_squared;
    if (t > 0 && t < 1) consider(p + t * edge);
  }

  void consider_interior(PairKind kind) {
    const Rational3 &p = corners_[0], u = corners_[1] - p, v = corners_[2] - p;
    const Rational uu = dot(u, u), uv = dot(u, v), vv = dot(v, v), determinant = uu * vv - uv * uv;
    if (determinant == 0) return;
    const Rational pu = dot(p, u), pv = dot(p, v);
    const Rational alpha = (uv * pv - vv * pu) / determinant, beta = (uv * pu - uu * pv) / determinant;
    const bool inside = kind == PairKind::kVf ? alpha + beta <= 1 : alpha <= 1 && beta <= 1;
    if (alpha >= 0 && beta >= 0 && inside) consider(p + alpha * u + beta * v);
  }

  std::array<Rational3, 4> corners_;
  Rational3 best_;
  Rational best_squared_;
  bool found_ = false;
};

}  // namespace selvage::testing
