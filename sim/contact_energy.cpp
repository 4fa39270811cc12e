#include "sim/contact_energy.h"

namespace selvage::sim {
namespace {

double elastic_j(const Spring& spring, const PositionsRef& x) {
  const double elongation = (x.row(spring.b) - x.row(spring.a)).norm() - spring.rest_length_m;
  return spring.stiffness_n_m / 2 * elongation * elongation;
}

}  // namespace

std::vector<ContactEnergy> contact_energies(const SpringSystem& springs, std::span<const std::int32_t> cloth_of,
                                            std::span<const double> inverse_mass, const Motion& end,
                                            const PositionsRef& x_t1, double fall_m_s) {
  std::vector<ContactEnergy> energies(cloth_of.empty() ? 0 : static_cast<std::size_t>(cloth_of.back()) + 1);
  for (const Spring& spring : springs.springs()) {
    ContactEnergy& of_cloth = energies[static_cast<std::size_t>(cloth_of[static_cast<std::size_t>(spring.a)])];
    const double before_j = elastic_j(spring, end.x);
    of_cloth.before_j += before_j;
    of_cloth.gain_j += elastic_j(spring, x_t1) - before_j;
  }
  for (std::size_t i = 0; i < cloth_of.size(); ++i) {
    if (inverse_mass[i] == 0) continue;
    const double squared = end.v.row(static_cast<Eigen::Index>(i)).squaredNorm() + fall_m_s * fall_m_s;
    energies[static_cast<std::size_t>(cloth_of[i])].before_j += squared / (2 * inverse_mass[i]);
  }
  return energies;
}

}  // namespace selvage::sim
