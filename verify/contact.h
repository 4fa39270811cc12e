// Contact of two moving features in binary forms: which polynomials to look at, and the exact decision from their
// signs. Formulation and proof of completeness: docs/guarantee.md, "Checker: motion".
#pragma once

#include <optional>
#include <span>

#include "verify/instant.h"

namespace selvage::verify {

/// x(t) = x_t0 s + x_t1 t, in whole numbers.
using MovingPoint = FormVector;

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
