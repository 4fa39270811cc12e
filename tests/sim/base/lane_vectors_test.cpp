#include "sim/base/lane_vectors.h"

#include <gtest/gtest.h>

namespace selvage::sim::testbed {

TEST(LaneVectors, WholeBlocksCanBeReadAroundAnyNumberOfRows) {
  for (const Eigen::Index rows : {0, 1, 8, 9}) {
    LaneVectors vectors;
    vectors.copy(Positions::Ones(rows, 3));
    EXPECT_EQ(vectors.rows(), rows);
    for (int k = 0; k < 3; ++k) {
      ASSERT_EQ(vectors.axis(k) - vectors.axis(0), k * (vectors.axis(1) - vectors.axis(0)));
      ASSERT_GE(vectors.axis(1) - vectors.axis(0), rows + 2 * kLanes) << rows;
      for (Eigen::Index i = -kLanes; i < rows + kLanes; ++i) {
        EXPECT_EQ(vectors.axis(k)[i], i >= 0 && i < rows ? 1 : 0) << rows;
      }
    }
  }
}

}  // namespace selvage::sim::testbed
