// What a collision step puts into springs, beside the energy that there is.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sim/dynamics.h"
#include "sim/spring.h"

namespace selvage::sim {

/// Of a cloth; stabilisers are left out, which are soft.
struct ContactEnergy {
  double gain_j = 0;    ///< elastic, by the collision step
  double before_j = 0;  ///< elastic, and of motion, after the dynamics
};

/// Of each cloth by itself, so that what else moves hides nothing. cloth_of[i] is that of vertex i, from 0 on. `end` is
/// where the dynamics led, x_t1 where the collision step let it be. Vertices count as if they fell at fall_m_s besides:
/// what cloth at rest falls in a step, contact takes up again. O(vertices + springs).
[[nodiscard]] std::vector<ContactEnergy> contact_energies(const SpringSystem& springs,
                                                          std::span<const std::int32_t> cloth_of,
                                                          std::span<const double> inverse_mass, const Motion& end,
                                                          const PositionsRef& x_t1, double fall_m_s);

}  // namespace selvage::sim
