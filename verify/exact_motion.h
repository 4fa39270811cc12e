// Exact decision whether two features touch while their vertices move on straight lines (docs/guarantee.md).
// Every finite double is in the domain; no tolerance anywhere.
#pragma once

#include <array>
#include <cstdint>
#include <string>

namespace selvage::verify {

using Point = std::array<double, 3>;

/// An exact time: the only root of an integer polynomial in [lower, upper], or lower == upper.
/// Ends are rationals in text, "numerator/denominator".
struct ExactTime {
  std::string lower = "0", upper = "0";
  double lower_approx = 0;  ///< largest double <= lower
  double upper_approx = 0;  ///< smallest double >= upper
};

enum class MotionKind : std::uint8_t {
  kNone,   ///< no touch for any t in [0,1]
  kTouch,  ///< touches at single times without passing through, or stays in touch
  kCross,  ///< transversal: the coplanarity cubic changes sign at a touch in the relative interiors
};

struct MotionAnswer {
  bool touches = false;
  MotionKind kind = MotionKind::kNone;
  ExactTime first;          ///< the first touch; width at most 2^-60 of the step; meaningful if touches
  bool exact_used = false;  ///< the filter did not decide
};

/// How much of the answer is wanted: the first time costs more than the bare decision.
enum class Detail : std::uint8_t { kDecision, kFirstTime };

/// x = {p, a, b, c} at t = 0 and t = 1: point p against the closed triangle (a, b, c). REQUIRES finite coordinates.
[[nodiscard]] MotionAnswer exact_vf_motion(const std::array<Point, 4>& x_t0, const std::array<Point, 4>& x_t1,
                                           Detail detail);
/// x = {a, b, c, d}: closed edge (a, b) against closed edge (c, d).
[[nodiscard]] MotionAnswer exact_ee_motion(const std::array<Point, 4>& x_t0, const std::array<Point, 4>& x_t1,
                                           Detail detail);
/// x = {p, a, b}: point p against the closed edge (a, b) of its own face: the extra event.
[[nodiscard]] MotionAnswer exact_self_motion(const std::array<Point, 3>& x_t0, const std::array<Point, 3>& x_t1,
                                             Detail detail);

/// -1, 0, 1: the exact first touch of `answer` (from one of the three above, with kFirstTime) against the double t;
/// used to check toi_lower. Decides exactly by refining the isolating interval of the same query.
[[nodiscard]] int compare_first_touch(const std::array<Point, 4>& x_t0, const std::array<Point, 4>& x_t1, bool is_vf,
                                      double t);

}  // namespace selvage::verify
