// Exact decision whether two features touch while their vertices move on straight lines (docs/guarantee-checker.md).
// Every finite double is in the domain; no tolerance anywhere.
#pragma once

#include <array>
#include <cstdint>

#include "verify/arithmetic/exact_time.h"
#include "verify/arithmetic/point.h"

namespace selvage::verify {

/// What happens at the first touch.
enum class MotionKind : std::uint8_t {
  kNone,   ///< no touch for any t in [0,1]
  kTouch,  ///< a touch that is no kCross: at a boundary, at t = 0 or 1, without passing through, or along coplanar
           ///< motion
  /// Transversal: inside (0,1), at a point in the interiors of both features (of the triangle, or of both edges), which
  /// span a plane there, and the coplanarity cubic changes sign. Right after it the features have passed through.
  kCross,
};

struct MotionAnswer {
  bool touches = false;
  MotionKind kind = MotionKind::kNone;
  ExactTime first;          ///< the first touch; width at most 2^-60 of the step; set if touches and kFirstTime
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
/// x = {p, a, b}: point p against the closed edge (a, b) of its own face: the extra event. Its kind is kTouch.
[[nodiscard]] MotionAnswer exact_self_motion(const std::array<Point, 3>& x_t0, const std::array<Point, 3>& x_t1,
                                             Detail detail);

/// The decision and, where the motion touches, when: for the price of one.
struct MotionAgainst {
  bool touches = false;
  int order = 1;            ///< sign of (first touch - t); 1 where nothing touches
  bool exact_used = false;  ///< the filter did not decide
};
/// Exact for every finite double t. REQUIRES finite coordinates.
[[nodiscard]] MotionAgainst vf_motion_against(const std::array<Point, 4>& x_t0, const std::array<Point, 4>& x_t1,
                                              double t);
[[nodiscard]] MotionAgainst ee_motion_against(const std::array<Point, 4>& x_t0, const std::array<Point, 4>& x_t1,
                                              double t);
[[nodiscard]] MotionAgainst self_motion_against(const std::array<Point, 3>& x_t0, const std::array<Point, 3>& x_t1,
                                                double t);

/// -1, 0, 1: the first touch of the vertex-face or edge-edge motion is before, at, or after t; exact for every double t
/// that is not NaN. Motions that do not touch answer 1. Used to check a kernel's toi_lower.
[[nodiscard]] int compare_first_touch(const std::array<Point, 4>& x_t0, const std::array<Point, 4>& x_t1, bool is_vf,
                                      double t);

}  // namespace selvage::verify
