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

TEST(LaneScalars, WholeBlocksCanBeReadAndAreZeroBeyondTheLast) {
  LaneScalars scalars;
  for (const std::size_t rows : {17U, 9U, 8U, 1U, 0U}) {  // fewer each time: nothing is left of those before
    scalars.copy(std::vector<double>(rows, 3));
    const auto lanes = static_cast<std::size_t>(kLanes);
    for (std::size_t i = 0; i < (rows + lanes - 1) / lanes * lanes; ++i) {
      EXPECT_EQ(scalars.data()[i], i < rows ? 3 : 0) << rows;
    }
  }
}

}  // namespace selvage::sim::testbed
