#include "sim/spring_energy.h"

#include "sim/parallel.h"

namespace selvage::sim {

double elastic_energy_j(const SpringSystem& springs, const PositionsRef& x) {
  const auto& all = springs.springs();
  std::vector<double> partial;
  return parallel_sum(std::ssize(all), partial, [&](Eigen::Index begin, Eigen::Index end) {
    double sum = 0;
    for (Eigen::Index i = begin; i < end; ++i) {
      const Spring& spring = all[static_cast<std::size_t>(i)];
      const double elongation = (x.row(spring.b) - x.row(spring.a)).norm() - spring.rest_length_m;
      sum += spring.stiffness_n_m / 2 * elongation * elongation;
    }
    return sum;
  });
}

}  // namespace selvage::sim
