#include "sim/contact_energy.h"

#include <cstdint>
#include <vector>

#include "sim/parallel.h"

namespace selvage::sim {
namespace {

double elastic_j(const Spring& spring, const PositionsRef& x) {
  const double elongation = (x.row(spring.b) - x.row(spring.a)).norm() - spring.rest_length_m;
  return spring.stiffness_n_m / 2 * elongation * elongation;
}

}  // namespace

ContactEnergy contact_energy(const SpringSystem& springs, std::span<const double> inverse_mass, const Motion& end,
                             const PositionsRef& x_t1, double fall_m_s) {
  std::vector<std::uint8_t> is_moved(static_cast<std::size_t>(springs.vertex_count()));
  parallel_each(std::ssize(is_moved),
                [&](Eigen::Index i) { is_moved[static_cast<std::size_t>(i)] = end.x.row(i) != x_t1.row(i) ? 1 : 0; });
  std::vector<std::uint8_t> is_end = is_moved;
  ContactEnergy sum;
  for (const Spring& spring : springs.springs()) {
    const auto a = static_cast<std::size_t>(spring.a), b = static_cast<std::size_t>(spring.b);
    if ((is_moved[a] | is_moved[b]) == 0) continue;
    is_end[a] = is_end[b] = 1;
    const double before_j = elastic_j(spring, end.x);
    sum.before_j += before_j;
    sum.gain_j += elastic_j(spring, x_t1) - before_j;
  }
  for (std::size_t i = 0; i < is_end.size(); ++i) {
    if (is_end[i] == 0 || inverse_mass[i] == 0) continue;
    const double squared = end.v.row(static_cast<Eigen::Index>(i)).squaredNorm() + fall_m_s * fall_m_s;
    sum.before_j += squared / (2 * inverse_mass[i]);
  }
  return sum;
}

}  // namespace selvage::sim
