// Contact of two moving features in binary forms: which polynomials to look at, and the exact decision from their
// signs. Formulation and proof of completeness: docs/guarantee-checker.md, "Checker: motion".
#pragma once

#include <array>
#include <optional>
#include <span>
#include <utility>

#include "verify/arithmetic/dyadic.h"
#include "verify/arithmetic/instant.h"
#include "verify/decision/exact_motion.h"

namespace selvage::verify {

/// x(t) = x_t0 s + x_t1 t, in whole numbers.
using MovingPoint = FormVector;

/// The paths in whole numbers: a common power of two scales all coordinates and changes no contact.
template <std::size_t N>
std::array<MovingPoint, N> moving_points(const std::array<Point, N>& x_t0, const std::array<Point, N>& x_t1) {
  std::array<double, 6 * N> values{};
  std::array<mpz_class, 6 * N> integers;
  for (std::size_t i = 0; i < N; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      values[6 * i + 2 * k] = x_t0[i][k];
      values[6 * i + 2 * k + 1] = x_t1[i][k];
    }
  }
  scale_to_integers(values, integers);
  std::array<MovingPoint, N> points;
  for (std::size_t i = 0; i < N; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      points[i][k].degree = 1;
      points[i][k].c[0] = std::move(integers[6 * i + 2 * k]);
      points[i][k].c[1] = std::move(integers[6 * i + 2 * k + 1]);
    }
  }
  return points;
}

/// A first touch, and whether it is transversal (MotionKind::kCross).
struct FirstTouch {
  Instant instant;
  bool is_cross = false;
};

/// First contact over the closed [0,1]: point x[0] with triangle x[1], x[2], x[3]; edges (x[0], x[1]) and (x[2], x[3]);
/// point x[0] with edge (x[1], x[2]).
[[nodiscard]] std::optional<FirstTouch> first_vf_touch(std::span<const MovingPoint, 4> x);
[[nodiscard]] std::optional<FirstTouch> first_ee_touch(std::span<const MovingPoint, 4> x);
[[nodiscard]] std::optional<FirstTouch> first_self_touch(std::span<const MovingPoint, 3> x);

}  // namespace selvage::verify
