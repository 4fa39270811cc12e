#include "sim/dynamics/velocity_march.h"

#include <algorithm>
#include <cmath>

#include "kernel/assert.h"

namespace selvage::sim {

std::int32_t march_velocity(const AccelerationOfVelocity& acceleration, double rate_upper_1_s,
                            const Eigen::ArrayXd& drag_1_s, double time_s, std::int32_t refinement, Positions& v) {
  SELVAGE_ASSERT(refinement >= 1);
  const double wanted = std::ceil(time_s * rate_upper_1_s / kMarchContraction) * refinement;
  // Written so that NaN and infinity end at the limit: the caller finds them in the velocity.
  const std::int32_t steps =
      wanted < kMarchStepLimit ? std::max(static_cast<std::int32_t>(wanted), refinement) : kMarchStepLimit;
  const double k = time_s / steps;
  Positions start, change;
  for (std::int32_t step = 0; step < steps; ++step) {
    start = v;
    for (std::int32_t iteration = 0; iteration < kFixedPointIterations; ++iteration) {
      acceleration(v, change);
      v = (start + k * change).array().colwise() / (1 + k * drag_1_s);
    }
  }
  return steps;
}

}  // namespace selvage::sim
