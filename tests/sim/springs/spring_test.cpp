#include "sim/springs/spring.h"

#include <cmath>

#include <gtest/gtest.h>

#include "sim/springs/stabilizer.h"

namespace selvage {

using namespace sim;

TEST(Spring, StableStepIsTheOscillatorsLimitAtMost) {
  // Two masses m on a spring k: omega^2 = 2 k / m.
  const double m = 0.002, k = 80;
  const std::vector<double> inverse_mass = {1 / m, 1 / m};
  const SpringSystem springs({Spring{0, 1, SpringKind::kStructural, 1.0, k, 0}}, 2);
  EXPECT_NEAR(stable_step_s(springs, inverse_mass), 2 / std::sqrt(2 * k / m), 1e-15);
}

}  // namespace selvage
