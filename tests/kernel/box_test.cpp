#include "kernel/box.h"

#include <gtest/gtest.h>

#include "tests/property.h"

namespace selvage {

namespace {

Box box_of(double x_t0, double x_t1, double reach) {
  const Positions V_t0 = Positions::Constant(1, 3, x_t0), V_t1 = Positions::Constant(1, 3, x_t1);
  return vertex_box(V_t0, V_t1, 0, reach);
}

/// Any finite double of the domain: sign, exponent and fraction drawn apart.
double any_coordinate() {
  const int exponent = *rc::gen::inRange(-1074, 1000);
  const double fraction = static_cast<double>(*rc::gen::inRange<std::int64_t>(0, std::int64_t{1} << 53)) * 0x1p-52;
  const double size = *rc::gen::element(0.0, 1.0, fraction, 1.0, fraction);
  return std::min(std::ldexp(size, exponent), kMaxCoordinate) * (*rc::gen::arbitrary<bool>() ? 1 : -1);
}

/// The sign of a + b - c over the real numbers, by error-free addition (Knuth): a + b = sum + rest exactly, and where
/// c is within a factor of two of sum, or sum is c's neighbour, sum - c is exact too.
int sign_of_sum(double a, double b, double c) {
  const double sum = a + b;
  const double b_rounded = sum - a;
  const double rest = (a - (sum - b_rounded)) + (b - b_rounded);
  const double difference = sum - c;
  return difference > -rest ? 1 : difference < -rest ? -1 : 0;
}

}  // namespace

TEST(Box, ZeroReachIsBitExact) {
  const Box box = box_of(0x1.8p-1074, -0.1, 0);
  EXPECT_EQ(box.lower[0], -0.1);
  EXPECT_EQ(box.upper[2], 0x1.8p-1074);
  EXPECT_EQ(box_of(kMaxCoordinate, kMaxCoordinate, 0).lower[1], kMaxCoordinate);
}

TEST(Box, HoldsBothEndsAlongEveryAxis) {
  Positions V_t0(2, 3), V_t1(2, 3);
  V_t0 << 9, 9, 9, 1, 5, -3;
  V_t1 << 9, 9, 9, 2, 4, -3;
  const Box box = vertex_box(V_t0, V_t1, 1, 0);
  EXPECT_EQ(box.lower, (std::array<double, 3>{1, 4, -3}));
  EXPECT_EQ(box.upper, (std::array<double, 3>{2, 5, -3}));
}

TEST(Box, GrowsByHalfTheReachAndOneStepOutward) {
  const Box box = box_of(1, 3, 1);
  EXPECT_EQ(box.lower[1], std::nextafter(0.5, 0));
  EXPECT_EQ(box.upper[1], std::nextafter(3.5, 4));
  const Box huge = box_of(-kMaxCoordinate, kMaxCoordinate, std::numeric_limits<double>::max());
  EXPECT_TRUE(std::isfinite(huge.lower[0]) && std::isfinite(huge.upper[0]));
}

/// The proof in box.h: never less than reach / 2, odd subnormal reaches included, and never much more.
TEST(Box, PropGrowthIsRoundedOutward) {
  testing::check_property(20000, 11, [] {
    const double x = any_coordinate();
    const double reach = *rc::gen::element(0x1p-1074, 0x3p-1074, std::abs(any_coordinate()) + 0x1p-1074);
    const Box box = box_of(x, x, reach);
    // 2 x - reach >= 2 lower over the reals; doubling is exact, and stays finite within the domain.
    RC_ASSERT(sign_of_sum(2 * x, -reach, 2 * box.lower[0]) >= 0);
    RC_ASSERT(sign_of_sum(2 * x, reach, 2 * box.upper[0]) <= 0);
    const double spread = std::max({std::abs(x), reach, 0x1p-1022}) * 0x1p-50;
    RC_ASSERT(box.lower[0] >= x - 0.5 * reach - spread);
    RC_ASSERT(box.upper[0] <= x + 0.5 * reach + spread);
  });
}

TEST(Box, OverlapIsClosed) {
  const Box a = box_of(0, 1, 0);
  EXPECT_TRUE(overlap(a, box_of(1, 2, 0)));
  EXPECT_TRUE(overlap(box_of(1, 2, 0), a));
  EXPECT_FALSE(overlap(a, box_of(std::nextafter(1, 2), 2, 0)));
  EXPECT_TRUE(overlap(a, box_of(0.5, 0.5, 0)));
  EXPECT_FALSE(overlap(a, Box{}));
  for (std::size_t axis = 0; axis < 3; ++axis) {  // one separating axis is enough, from either side
    for (const double shift : {-3.0, 3.0}) {
      Box b = a;
      b.lower[axis] += shift;
      b.upper[axis] += shift;
      EXPECT_FALSE(overlap(a, b)) << axis;
    }
  }
}

TEST(MovingBox, IsApartFromWhatItIsAboveAtBothEnds) {
  const MovingBox box{box_of(0, 1, 0), box_of(10, 11, 0)};
  const double above = std::nextafter(1.0, 2.0), below = std::nextafter(10.0, 0.0);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto other = [&](double lower_t0, double upper_t0, double lower_t1, double upper_t1) {
      MovingBox result = box;
      result.t0.lower[axis] = lower_t0;
      result.t0.upper[axis] = upper_t0;
      result.t1.lower[axis] = lower_t1;
      result.t1.upper[axis] = upper_t1;
      return result;
    };
    const auto meet = [&](const MovingBox& b) {
      EXPECT_EQ(overlap(box, b), overlap(b, box));
      return overlap(box, b);
    };
    EXPECT_TRUE(meet(other(1, 2, 12, 13))) << axis;  // touch at one end
    EXPECT_TRUE(meet(other(5, 6, 11, 12))) << axis;
    EXPECT_TRUE(meet(other(5, 6, 5, 6))) << axis;         // from above to below
    EXPECT_FALSE(meet(other(above, 2, 12, 13))) << axis;  // where swept boxes overlap
    EXPECT_FALSE(meet(other(-2, -1, 5, below))) << axis;
  }
}

/// What box.h says of pairs left out, for points on a lattice, at sixteenths of the way: their coordinates are exact.
TEST(MovingBox, PropPairsApartAreNowhereNear) {
  testing::check_property(20000, 10, [] {
    const int extent = *rc::gen::element(3, 30, 300);
    const auto coordinates = *rc::gen::container<std::array<int, 12>>(rc::gen::inRange(-extent, extent + 1));
    Positions V_t0(2, 3), V_t1(2, 3);
    for (Eigen::Index i = 0; i < 6; ++i) {
      V_t0(i / 3, i % 3) = coordinates[static_cast<std::size_t>(i)];
      V_t1(i / 3, i % 3) = coordinates[static_cast<std::size_t>(6 + i)];
    }
    const double reach = *rc::gen::element(0.0, 1.0, 2.5, 0x1p-1074);
    const auto meet = [&](MotionBoxes boxes) {
      return overlap(vertex_box(V_t0, V_t1, 0, reach, boxes), vertex_box(V_t0, V_t1, 1, reach, boxes));
    };
    RC_ASSERT(meet(MotionBoxes::kSwept) == overlap(vertex_box(V_t0, V_t1, 0, reach), vertex_box(V_t0, V_t1, 1, reach)));
    if (meet(MotionBoxes::kMoving)) {
      RC_ASSERT(meet(MotionBoxes::kSwept));
      return;
    }
    for (int i = 0; i <= 16; ++i) {
      const double t = i / 16.0;
      const Eigen::RowVector3d apart = (1 - t) * (V_t0.row(1) - V_t0.row(0)) + t * (V_t1.row(1) - V_t1.row(0));
      RC_ASSERT(apart.cwiseAbs().maxCoeff() > reach);
    }
  });
}

}  // namespace selvage
