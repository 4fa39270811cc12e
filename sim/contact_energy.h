// What a collision step puts into springs, beside the energy that there is.
#pragma once

#include <span>
#include <vector>

#include "sim/contact/surface_parts.h"
#include "sim/dynamics/dynamics.h"
#include "sim/springs/spring.h"

namespace selvage::sim {

/// Of a part of the cloth; stabilisers are left out, which are soft.
struct ContactEnergy {
  double gain_j = 0;    ///< elastic, by the collision step
  double before_j = 0;  ///< elastic, and of motion, after the dynamics
};

/// Of each connected part by itself, at its smallest vertex, so that what else moves hides nothing. `end` is where the
/// dynamics led, x_t1 where the collision step let it be. Vertices count as if they fell at fall_m_s besides: what
/// cloth at rest falls in a step, contact takes up again. O(vertices + springs).
[[nodiscard]] std::vector<ContactEnergy> contact_energies(const SpringSystem& springs, const SurfaceParts& parts,
                                                          std::span<const double> inverse_mass, const Motion& end,
                                                          const PositionsRef& x_t1, double fall_m_s);

}  // namespace selvage::sim
