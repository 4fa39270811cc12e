#include "sim/dynamics/velocity_march.h"

#include <algorithm>
#include <cmath>

namespace selvage::sim {

void march_velocity(const AccelerationOfVelocity& acceleration, const RowDrag& drag, double rate_upper_1_s,
                    double time_s, Positions& v) {
  const double wanted = std::ceil(time_s * rate_upper_1_s / kMarchContraction);
  // Written so that NaN and infinity end at the limit: the caller finds them in the velocity.
  const int steps = wanted < kMarchStepLimit ? std::max(static_cast<int>(wanted), 1) : kMarchStepLimit;
  const double k = time_s / steps;
  Positions start, change;
  for (int step = 0; step < steps; ++step) {
    start = v;
    for (int iteration = 0; iteration < kFixedPointIterations; ++iteration) {
      acceleration(v, change);
      const Eigen::ArrayXd drag_1_s = drag.linear_1_s + drag.quadratic_1_m * v.rowwise().norm().array();
      v = (start + k * change).array().colwise() / (1 + k * drag_1_s);
    }
  }
}

}  // namespace selvage::sim
