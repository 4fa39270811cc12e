#include "sim/base/keep_largest.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace selvage::sim {

TEST(KeepLargest, KeepsTheLargestNumber) {
  double largest = 0;
  for (const double value : {2e-5, 1e-5, 3e-5, -1.0}) keep_largest(value, largest);
  EXPECT_EQ(largest, 3e-5);
}

TEST(KeepLargest, KeepsWhatIsNoNumberWhateverFollows) {
  double largest = 0;
  for (const double value : {2e-5, std::numeric_limits<double>::quiet_NaN(), 1e-5, 3e-5}) keep_largest(value, largest);
  EXPECT_TRUE(std::isnan(largest)) << largest;
}

}  // namespace selvage::sim
