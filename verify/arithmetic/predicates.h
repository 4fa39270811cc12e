// Exact signs of orientations. A floating-point filter with a proved bound answers first, integers where it cannot.
#pragma once

#include <array>
#include <memory>
#include <span>

#include <gmpxx.h>

#include "verify/arithmetic/point.h"

namespace selvage::verify {

/// The filter alone: the sign of det(b - a, c - a, d - a) where rounding cannot change it, else 0 ("do not know").
/// Valid for all finite input in the environment of FpGuard.
[[nodiscard]] int triage_orient3d(const Point& a, const Point& b, const Point& c, const Point& d);
/// The same for component `axis` of (b - a) x (c - a).
[[nodiscard]] int triage_normal(int axis, const Point& a, const Point& b, const Point& c);

/// Exact predicates on up to six points, which are named by their position in `points`. The points must outlive it.
class Predicates {
 public:
  explicit Predicates(std::span<const Point> points) : points_(points) {}

  /// Sign of det(b - a, c - a, d - a).
  [[nodiscard]] int orient3d(int a, int b, int c, int d);
  /// Sign of component `axis` of (b - a) x (c - a).
  [[nodiscard]] int normal(int axis, int a, int b, int c);
  /// Sign of point[a][axis] - point[b][axis].
  [[nodiscard]] int compare(int axis, int a, int b) const;
  [[nodiscard]] bool equal(int a, int b) const;
  /// The first axis along which the triangle keeps its area in projection; -1 if it has none (zero-area).
  [[nodiscard]] int projection_axis(int a, int b, int c);
  /// Whether the filter left a sign open.
  [[nodiscard]] bool exact_used() const { return integers_ != nullptr; }

 private:
  using IntegerPoint = std::array<mpz_class, 3>;
  const IntegerPoint& integer(int a);

  std::span<const Point> points_;
  std::unique_ptr<std::array<IntegerPoint, 6>> integers_;  // all coordinates times one power of two; made when needed
};

}  // namespace selvage::verify
