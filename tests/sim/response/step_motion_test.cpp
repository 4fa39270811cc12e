// The motion of a step: displacements, from which velocities come, and the positions that are stored.
#include "sim/response/step_motion.h"

#include <gtest/gtest.h>

namespace selvage::sim {
namespace {

constexpr auto kFloat64 = Precision::kFloat64;
constexpr double kNearTheEnd = kMaxCoordinate / 4;

Positions point(double x) {
  Positions V(1, 3);
  V << x, 0, 0;
  return V;
}

}  // namespace

TEST(StepMotion, WhatIsFrozenHasNoVelocity) {
  StepMotion motion;
  motion.start(point(1), point(3), kFloat64);
  EXPECT_EQ(motion.displacement()(0, 0), 2);
  motion.freeze(0);
  EXPECT_EQ(motion.x(), motion.V_t0());
  EXPECT_TRUE(motion.displacement().isZero(0));
}

TEST(StepMotion, GoesAsFarAsTheDomainAndNoFaster) {
  StepMotion motion;
  motion.start(point(kNearTheEnd), point(8 * kMaxCoordinate), kFloat64);
  EXPECT_EQ(motion.x()(0, 0), kMaxCoordinate);
  EXPECT_EQ(motion.displacement()(0, 0), 3 * kNearTheEnd);
  motion.move(0, Vec3(-kMaxCoordinate, 1, 0));
  EXPECT_EQ(motion.displacement().row(0), Eigen::RowVector3d(-kMaxCoordinate, 1, 0));
  motion.move(0, Vec3(-8 * kMaxCoordinate, 1, 0));
  EXPECT_EQ(motion.x()(0, 0), -kMaxCoordinate);
  EXPECT_EQ(motion.displacement().row(0), Eigen::RowVector3d(-5 * kNearTheEnd, 1, 0));
}

}  // namespace selvage::sim
