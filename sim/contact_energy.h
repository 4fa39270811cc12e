// What a collision step puts into springs, beside the energy that there is.
#pragma once

#include <span>
#include <vector>

#include "sim/contact/repulsion_contact.h"
#include "sim/contact/surface_parts.h"
#include "sim/springs/spring.h"

namespace selvage::sim {

/// The balance of one connected part of the cloth. Stabilisers, which are soft, are left out.
struct ContactEnergy {
  double gain_j = 0;    ///< elastic, by the collision step
  double before_j = 0;  ///< elastic, and of motion beside what it met, after the dynamics
};

/// What a collision step has done, #V by 3. A pair is named once: by what the dynamics held, or by what was met
/// besides.
struct ResolvedStep {
  const Positions& x_before;  ///< where the dynamics led
  const Positions& x_after;   ///< where the collision step let it be
  const Positions& v_before;  ///< after the dynamics, of bodies as well
  std::span<const RepulsionContact> held, met;
};

/// Of each connected part by itself, at its smallest vertex, so that what else moves hides nothing. Motion counts
/// beside the mean velocity of the part's contacts, each that of the centre of mass of its two points, once for either
/// side: counted in the world, what sheet and box had in common hid what contact put in. Stiff cloth that fell on a
/// box, both at 20 m/s, came to 2.4 times its energy as the box sees it (tests/sim/energy_test.cpp). Vertices count as
/// if they fell at fall_m_s besides: what cloth at rest falls in a step, contact takes up again. O(vertices + springs +
/// contacts).
[[nodiscard]] std::vector<ContactEnergy> contact_energies(const SpringSystem& springs, const SurfaceParts& parts,
                                                          std::span<const double> inverse_mass,
                                                          const ResolvedStep& step, double fall_m_s);

}  // namespace selvage::sim
