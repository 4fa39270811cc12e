// How many steps drag asks for that grows with speed.
#pragma once

#include <span>

#include "kernel/types.h"

namespace selvage::sim {

/// The rate at which drag -q |v| v, with q in 1/m, brakes the fastest vertex that can move; 1/s. Free where q is 0.
[[nodiscard]] double quadratic_drag_1_s(double quadratic_drag_1_m, const Positions& v,
                                        std::span<const double> inverse_mass);

/// Of dt_s, such that drag of that rate would take no more than half of a velocity in one of them: dynamics find it at
/// a velocity that they begin or end with. 64 at most, at least 1: beyond, what is stopped goes as far as half or three
/// times as much as it should (free flight at 1 km/s with 1,000 1/m), never back.
[[nodiscard]] int steps_for_drag(double rate_1_s, double dt_s);

}  // namespace selvage::sim
