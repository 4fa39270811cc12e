#include "sim/bodies/catch_up.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace selvage::sim {
namespace {

constexpr double kStep = 1e-3;

Positions tetrahedron() {
  Positions x(4, 3);
  x << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1;
  return x;
}

Positions moved(const Positions& x, const Vec3& by, double angle = 0) {
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(angle, Vec3(1, 2, 2) / 3).toRotationMatrix();
  return (x * turn.transpose()).rowwise() + by.transpose();
}

double farthest(const Positions& a, const Positions& b) { return (a - b).rowwise().norm().maxCoeff(); }

}  // namespace

TEST(CatchUp, IsAtItsScriptWhereThatIsNotFar) {
  const Positions x = tetrahedron(), script_t1 = moved(x, Vec3(0.3, 0.1, 0), 0.2);
  EXPECT_EQ(catch_up(x, x, script_t1, kStep, 0), script_t1) << "no lag, whatever the speed";
  const Positions near = moved(x, Vec3(1e-5, 0, 0));
  EXPECT_EQ(catch_up(x, near, near, kStep, 0.02), near) << "as far as the least speed goes";
}

TEST(CatchUp, GoesTowardsItRigidlyAndAsFastAsTheLagSays) {
  const Positions x = tetrahedron(), script = moved(x, Vec3(0.4, -0.2, 0.1), 1.2);
  const double lag = farthest(x, script);
  const Positions next = catch_up(x, script, script, kStep, 0);
  EXPECT_NEAR(farthest(x, next), lag * kStep / kCatchUpTime_s, 0.2 * lag * kStep / kCatchUpTime_s);
  EXPECT_LT(farthest(next, script), lag);
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < i; ++j) {
      EXPECT_NEAR((next.row(i) - next.row(j)).norm(), (x.row(i) - x.row(j)).norm(), 1e-14);
    }
  }
}

TEST(CatchUp, ComesBackInTimeToTheBit) {
  Positions x = tetrahedron();
  const Positions script = moved(x, Vec3(0.4, -0.2, 0.1), 2.5);
  int steps = 0;
  while (x != script && steps < 1000) {
    x = catch_up(x, script, script, kStep, 0.03);
    ++steps;
  }
  EXPECT_LT(steps, 800) << "eight times kCatchUpTime_s";
  EXPECT_GT(steps, 100);
}

TEST(CatchUp, AVertexOfABodyThatDeformsComesBackByItself) {
  Positions x = tetrahedron();
  Positions script = moved(x, Vec3(0.1, 0, 0));
  x.row(1) = script.row(1);
  script.row(3) *= 2;
  EXPECT_EQ(catch_up_each(x, script, script, kStep, 0).row(1), script.row(1));
  const Positions next = catch_up_each(x, script, script, kStep, 0.03);
  for (const int v : {0, 2, 3}) {
    const double lag = (script.row(v) - x.row(v)).norm();
    EXPECT_NEAR((next.row(v) - x.row(v)).norm(), std::max(lag * kStep / kCatchUpTime_s, kStep * 0.03), 1e-15);
    EXPECT_NEAR((script.row(v) - next.row(v)).norm(), lag - (next.row(v) - x.row(v)).norm(), 1e-15) << "straight";
  }
  int steps = 0;
  for (; x != script && steps < 1000; ++steps) x = catch_up_each(x, script, script, kStep, 0.03);
  EXPECT_LT(steps, 800);
  EXPECT_GT(steps, 100);
}

}  // namespace selvage::sim
