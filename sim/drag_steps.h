// How many steps drag asks for that grows with speed.
#pragma once

#include <span>

#include "kernel/types.h"

namespace selvage::sim {

/// The speed of the fastest vertex that can move, m/s.
[[nodiscard]] double fastest_speed(const Positions& v, std::span<const double> inverse_mass);

/// Of dt_s, such that drag -q |v| v, with q in 1/m, would take no more than half of a velocity in one of them: dynamics
/// find it at a velocity that they begin or end with. 64 at most, at least 1: beyond, what is stopped goes as far as
/// half or twice as much as it should in the first of them (free flight at 1 km/s with 1,000 1/m), never back.
[[nodiscard]] int steps_for_drag(double quadratic_drag_1_m, double fastest_m_s, double dt_s);

}  // namespace selvage::sim
