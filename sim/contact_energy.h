// What a collision step puts into springs, beside the energy that there is where it acts.
#pragma once

#include <span>

#include "sim/dynamics.h"
#include "sim/spring.h"

namespace selvage::sim {

/// Of the springs at vertices that the collision step moved. Stabilisers are left out, which are soft.
struct ContactEnergy {
  double gain_j = 0;    ///< elastic, by the collision step
  double before_j = 0;  ///< elastic, and the motion of their ends, after the dynamics
};

/// `end` is where the dynamics led the cloth, x_t1 where the collision step let it be. The ends of springs count as if
/// they fell at fall_m_s besides: what a step falls in rest, contact takes up again. O(vertices + springs), same bits
/// for any thread count.
[[nodiscard]] ContactEnergy contact_energy(const SpringSystem& springs, std::span<const double> inverse_mass,
                                           const Motion& end, const PositionsRef& x_t1, double fall_m_s);

}  // namespace selvage::sim
