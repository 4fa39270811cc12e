#include "sim/dynamics/drag_steps.h"

#include <algorithm>
#include <cmath>

namespace selvage::sim {
namespace {

/// Bounds what a scene can ask for. A sheet of 0.05 kg/m^2 (12 1/m) that moves at 100 m/s asks for 40 in a frame.
constexpr double kMaxSteps = 64;

}  // namespace

double quadratic_drag_1_s(double quadratic_drag_1_m, const Positions& v, std::span<const double> inverse_mass) {
  if (quadratic_drag_1_m == 0) return 0;
  double fastest_m_s = 0;
  for (Eigen::Index i = 0; i < v.rows(); ++i) {
    if (inverse_mass[static_cast<std::size_t>(i)] > 0) fastest_m_s = std::max(fastest_m_s, v.row(i).norm());
  }
  return quadratic_drag_1_m * fastest_m_s;
}

int steps_for_drag(double rate_1_s, double dt_s) {
  return static_cast<int>(std::ceil(std::clamp(dt_s * rate_1_s, 1.0, kMaxSteps)));
}

}  // namespace selvage::sim
