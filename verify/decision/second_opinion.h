// A second exact decider for moving features, built differently on purpose, to check the first one (exact_motion.h).
//
// Monomials instead of Bernstein forms, CGAL's algebraic kernel instead of own root isolation, weights as quotients of
// quartics, lengths of cross products instead of components, and no theorem on where coplanar motion first touches: it
// tries every time at which a sign that decides changes. About ten times slower.
#pragma once

#include <array>
#include <cstdint>

#include "verify/decision/exact_motion.h"

namespace selvage::verify {

struct SecondOpinion {
  bool touches = false;
  double first_lower = 0, first_upper = 0;  ///< doubles around the exact first touch, within 2^-50; if touches
};

/// The same questions, argument orders and domain as exact_vf_motion, exact_ee_motion and exact_self_motion.
[[nodiscard]] SecondOpinion second_opinion_vf(const std::array<Point, 4>& x_t0, const std::array<Point, 4>& x_t1);
[[nodiscard]] SecondOpinion second_opinion_ee(const std::array<Point, 4>& x_t0, const std::array<Point, 4>& x_t1);
[[nodiscard]] SecondOpinion second_opinion_self(const std::array<Point, 3>& x_t0, const std::array<Point, 3>& x_t1);

/// Whether two faces have a point in common beyond the vertices that they share by index: CGAL constructs what they
/// have in common, in rationals, where exact_overlap decides by signs. Arguments as there.
[[nodiscard]] bool second_opinion_overlap(const std::array<std::int32_t, 3>& face_a, const std::array<Point, 3>& a,
                                          const std::array<std::int32_t, 3>& face_b, const std::array<Point, 3>& b);
/// Whether the corners are collinear or coincide.
[[nodiscard]] bool second_opinion_degenerate(const std::array<Point, 3>& a);

/// All of them. A table, so that a test can put in one that lies.
struct SecondDeciders {
  decltype(&second_opinion_vf) vf = second_opinion_vf;
  decltype(&second_opinion_ee) ee = second_opinion_ee;
  decltype(&second_opinion_self) self = second_opinion_self;
  decltype(&second_opinion_overlap) overlap = second_opinion_overlap;
  decltype(&second_opinion_degenerate) degenerate = second_opinion_degenerate;
};

}  // namespace selvage::verify
