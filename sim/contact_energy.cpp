#include "sim/contact_energy.h"

namespace selvage::sim {

std::vector<ContactEnergy> contact_energies(const SpringSystem& springs, const SurfaceParts& parts,
                                            std::span<const double> inverse_mass, const Motion& end,
                                            const PositionsRef& x_t1, double fall_m_s) {
  std::vector<ContactEnergy> energies(static_cast<std::size_t>(springs.vertex_count()));
  const auto of_part = [&](VertexId i) -> ContactEnergy& { return energies[static_cast<std::size_t>(parts.part(i))]; };
  for (const Spring& spring : springs.springs()) {
    ContactEnergy& energy = of_part(spring.a);
    const double before_j = elastic_j(spring, end.x);
    energy.before_j += before_j;
    energy.gain_j += elastic_j(spring, x_t1) - before_j;
  }
  for (VertexId i = 0; i < springs.vertex_count(); ++i) {
    const double w = inverse_mass[static_cast<std::size_t>(i)];
    if (w > 0) of_part(i).before_j += (end.v.row(i).squaredNorm() + fall_m_s * fall_m_s) / (2 * w);
  }
  return energies;
}

}  // namespace selvage::sim
