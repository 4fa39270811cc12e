#include "sim/dynamics/scripted_ends.h"

namespace selvage::sim {

void start_scripts(Motion& motion, const PositionsRef& scripted_x_t1, std::span<const double> inverse_mass,
                   double dt_s) {
  for (Eigen::Index i = 0; i < motion.x.rows(); ++i) {
    if (inverse_mass[static_cast<std::size_t>(i)] == 0) {
      motion.v.row(i) = (scripted_x_t1.row(i) - motion.x.row(i)) / dt_s;
    }
  }
}

void end_scripts(Positions& x, const PositionsRef& scripted_x_t1, std::span<const double> inverse_mass) {
  for (Eigen::Index i = 0; i < x.rows(); ++i) {
    if (inverse_mass[static_cast<std::size_t>(i)] == 0) x.row(i) = scripted_x_t1.row(i);
  }
}

}  // namespace selvage::sim
