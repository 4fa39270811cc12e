// Vertices that follow a script through a step of any dynamics.
#pragma once

#include <span>

#include "sim/dynamics/dynamics.h"

namespace selvage::sim {

/// Rows with inverse mass 0 get the velocity that takes them to `scripted_x_t1` in dt_s.
void start_scripts(Motion& motion, const PositionsRef& scripted_x_t1, std::span<const double> inverse_mass,
                   double dt_s);
/// They are where the script says, to the bit.
void end_scripts(Positions& x, const PositionsRef& scripted_x_t1, std::span<const double> inverse_mass);

}  // namespace selvage::sim
