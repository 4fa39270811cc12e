// How a body that had to wait (S4, squeeze = "yield") comes back to its script.
#pragma once

#include "kernel/types.h"

namespace selvage::sim {

/// What is left of a lag after this time is a part 1/e of it: fast beside what a viewer calls late, slow beside a step.
/// Without such a limit a hand that had been held back by 0.2 m made them up in one step of 2 ms.
inline constexpr double kCatchUpTime_s = 0.1;

/// Where vertices at x go in a step of dt_s, rigidly, when their script is at script_t0 at its start and at script_t1
/// at its end: script_t1, to the bit, where that is no farther than the script goes in the step and dt_s max(lag /
/// kCatchUpTime_s, least_speed_m_s) on top; as far as that towards it elsewhere. All as many rows, at least one; m.
[[nodiscard]] Positions catch_up(const Positions& x, const Positions& script_t0, const Positions& script_t1,
                                 double dt_s, double least_speed_m_s);
/// The same for a body that deforms: every vertex by itself, straight.
[[nodiscard]] Positions catch_up_each(const Positions& x, const Positions& script_t0, const Positions& script_t1,
                                      double dt_s, double least_speed_m_s);

}  // namespace selvage::sim
