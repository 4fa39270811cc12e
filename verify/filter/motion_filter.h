// The filter of exact_motion: cheap proofs that two moving features never touch, or that they pass through each other.
//
// Takes any finite input; degenerate features are allowed. REQUIRES the environment of FpGuard, which these functions
// do not set themselves: a loop over pairs sets it once. Cost: 20 to 100 ns for most pairs, at most about 3 us.
#pragma once

#include <array>
#include <cstdint>

#include "verify/arithmetic/point.h"

namespace selvage::verify {

enum class MotionTriage : std::uint8_t {
  kApart,       ///< proved: no touch for any t in [0,1] (MotionKind::kNone)
  kCrosses,     ///< proved: the first touch is transversal (MotionKind::kCross)
  kUnresolved,  ///< not known
};

/// Argument orders as in exact_motion.h.
[[nodiscard]] MotionTriage triage_vf_motion(const std::array<Point, 4>& x_t0,
                                            const std::array<Point, 4>& x_t1) noexcept;
[[nodiscard]] MotionTriage triage_ee_motion(const std::array<Point, 4>& x_t0,
                                            const std::array<Point, 4>& x_t1) noexcept;
/// Never kCrosses.
[[nodiscard]] MotionTriage triage_self_motion(const std::array<Point, 3>& x_t0,
                                              const std::array<Point, 3>& x_t1) noexcept;

}  // namespace selvage::verify
