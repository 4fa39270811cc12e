#include "sim/drag_steps.h"

#include <algorithm>
#include <cmath>

namespace selvage::sim {
namespace {

constexpr double kMostSteps = 64;

}  // namespace

double fastest_speed(const Positions& v, std::span<const double> inverse_mass) {
  double fastest_m_s = 0;
  for (Eigen::Index i = 0; i < v.rows(); ++i) {
    if (inverse_mass[static_cast<std::size_t>(i)] > 0) fastest_m_s = std::max(fastest_m_s, v.row(i).norm());
  }
  return fastest_m_s;
}

int steps_for_drag(double quadratic_drag_1_m, double fastest_m_s, double dt_s) {
  return static_cast<int>(std::ceil(std::clamp(dt_s * quadratic_drag_1_m * fastest_m_s, 1.0, kMostSteps)));
}

}  // namespace selvage::sim
