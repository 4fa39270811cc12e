#include "sim/bodies/blocked_ways.h"

#include <array>
#include <cmath>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace selvage::sim {
namespace {

constexpr double kStep = 1e-3, kThickness = 4e-3;
/// Out of what blocks it, in a step.
constexpr double kBack = kStep * kThickness / kCatchUpTime_s;

Positions tetrahedron() {
  Positions x(4, 3);
  x << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1;
  return x;
}

Positions moved(const Positions& x, const Vec3& by) { return x.rowwise() + by.transpose(); }

Blockage blockage(const Vec3& direction, const Vec3& at = Vec3::Zero(), std::int32_t body = 0) {
  return {body, Blockage::kWholeBody, at, direction.normalized()};
}

/// Of a body that deforms.
Blockage vertex_blockage(VertexId vertex, const Vec3& direction) { return {0, vertex, Vec3::Zero(), direction}; }

BlockedWays ways(const std::vector<Blockage>& blockages) {
  BlockedWays result(kThickness);
  result.start_step(0);
  EXPECT_EQ(result.add(blockages), !blockages.empty());
  return result;
}

constexpr std::array<VertexId, 4> kRows = {10, 11, 12, 13};

/// Where it goes that would go from x to x_t1. It is rigid unless blockages name its vertices.
Positions led(const BlockedWays& ways, const Positions& x, const Positions& x_t1, std::int32_t body = 0) {
  Positions result = x_t1;
  const bool is_led = ways.lead_round(body, kRows, x, kStep, result);
  EXPECT_EQ(is_led, result != x_t1);
  return result;
}

/// How far a tetrahedron goes that would go on by `by`.
Vec3 goes(const BlockedWays& ways, const Vec3& by) {
  const Positions x = tetrahedron(), way = led(ways, x, moved(x, by)) - x;
  EXPECT_LT((way.rowwise() - way.row(0)).norm(), 1e-15) << "rigidly";
  return way.row(0);
}

}  // namespace

TEST(BlockedWays, LeadAlongWhatIsInTheWayAndOutOfIt) {
  const Vec3 on_ground = goes(ways({blockage(Vec3::UnitZ())}), Vec3(0.3, 0.1, -0.02));
  EXPECT_LT((on_ground - Vec3(0.3, 0.1, kBack)).norm(), 1e-15);
  const Vec3 in_corner = goes(ways({blockage(Vec3::UnitZ()), blockage(Vec3(-1, 0, 1))}), Vec3(0.3, 0.1, -0.02));
  EXPECT_NEAR(in_corner.y(), 0.1, 1e-12);
  EXPECT_GE(in_corner.z(), kBack * (1 - 1e-9));
  EXPECT_GE(Vec3(-1, 0, 1).normalized().dot(in_corner), kBack * (1 - 1e-9));
}

TEST(BlockedWays, DoNotHoldWhatGoesAway) {
  const BlockedWays blocked = ways({blockage(Vec3::UnitZ())});
  const Positions x = tetrahedron(), up = moved(x, Vec3(0.3, 0, 0.01));
  EXPECT_EQ(led(blocked, x, up), up);
  const Positions down = moved(x, Vec3(0, 0, -1));
  EXPECT_EQ(led(blocked, x, down, 1), down) << "another body";
}

TEST(BlockedWays, CountTheMotionWhereTheBodyIsBlocked) {
  // It turns about x: the vertex at y = 1 goes down, and what is at the origin does not.
  const Positions x = tetrahedron();
  const Positions x_t1 = x * Eigen::AngleAxisd(-0.1, Vec3::UnitX()).toRotationMatrix().transpose();
  const double down = x(2, 2) - x_t1(2, 2);
  ASSERT_GT(down, 0.05);
  const auto up = [&](const Vec3& at) { return (led(ways({blockage(Vec3::UnitZ(), at)}), x, x_t1) - x_t1)(0, 2); };
  EXPECT_NEAR(up(Vec3::UnitY()), down + kBack, 1e-12);
  EXPECT_NEAR(up(Vec3::Zero()), kBack, 1e-12);
}

TEST(BlockedWays, BackOutByAShareOfTheThicknessAndEnd) {
  BlockedWays blocked = ways({blockage(Vec3::UnitZ())});
  double height = 0, time_s = 0;
  int steps = 0;
  for (; !blocked.all().empty(); ++steps) {
    ASSERT_LT(steps, 1000);
    height += goes(blocked, Vec3::Zero()).z();
    blocked.end_step(kStep);
    time_s += kStep;
    blocked.start_step(time_s);
  }
  EXPECT_NEAR(height, kBackShare * kThickness, 1e-12);
  EXPECT_NEAR(steps, kBlockedTime_s / kStep, 1);
}

TEST(BlockedWays, LeadNotFarOutOfAWedge) {
  // There is a way, as long as the wedge is narrow.
  for (double half_angle = 1; half_angle > 1e-9; half_angle *= 0.9) {
    const double along = std::sin(half_angle), across = std::cos(half_angle);
    const BlockedWays blocked = ways({blockage(Vec3(along, across, 0)), blockage(Vec3(along, -across, 0))});
    EXPECT_LT(goes(blocked, Vec3::Zero()).norm(), 9.1 * kBack) << half_angle;
  }
}

TEST(BlockedWays, OfALaterStepTakeThePlaceOfEarlierOnes) {
  const Vec3 near(kThickness, 0, 0);
  BlockedWays blocked = ways({blockage(Vec3::UnitZ(), near), blockage(Vec3::UnitX(), near), blockage(Vec3(0, 0.1, 1)),
                              blockage(Vec3::UnitZ(), near, 1), blockage(Vec3::UnitZ(), Vec3::UnitX())});
  blocked.start_step(kStep);
  const Blockage later = blockage(Vec3(0.05, 0, 1));
  EXPECT_TRUE(blocked.add(std::vector{later}));
  ASSERT_EQ(blocked.all().size(), 4U);
  EXPECT_EQ(blocked.all()[0].blockage.direction, Vec3(Vec3::UnitX())) << "another direction";
  EXPECT_EQ(blocked.all()[1].blockage.body, 1) << "another body";
  EXPECT_EQ(blocked.all()[2].blockage.at_m, Vec3(Vec3::UnitX())) << "far away";
  EXPECT_EQ(blocked.all()[3].blockage, later);
}

TEST(BlockedWays, OfABodyThatDeformsLeadWhatIsNear) {
  constexpr double kReach = kReachThicknesses * kThickness;
  const BlockedWays blocked = ways({vertex_blockage(11, Vec3::UnitZ())});
  Positions x = Positions::Zero(4, 3);
  x.col(0) << 0.5 * kReach, 0, 0.999 * kReach, 1.001 * kReach;
  const Vec3 by(1e-3, 2e-3, -3e-3);
  const Positions way = led(blocked, x, moved(x, by)) - x;
  EXPECT_LT((way.leftCols(2).rowwise() - by.head(2).transpose()).norm(), 1e-15) << "along what blocks it";
  EXPECT_NEAR(way(1, 2), kBack, 1e-15);
  EXPECT_NEAR(way(0, 2), 0.5 * kBack, 1e-15) << "the less the farther it is";
  EXPECT_NEAR(way(2, 2), 0.001 * kBack, 1e-12);
  EXPECT_EQ(way(3, 2), by.z()) << "out of reach";
  const Positions at_rest = led(blocked, x, x) - x;
  EXPECT_NEAR(at_rest(1, 2), kBack, 1e-15);
  EXPECT_EQ(at_rest(0, 2), 0) << "does not go against it";
}

TEST(BlockedWays, OfABodyThatDeformsAreAddedOnceAStepForEachVertex) {
  BlockedWays blocked = ways({vertex_blockage(11, Vec3::UnitZ())});
  EXPECT_FALSE(blocked.add(std::vector{vertex_blockage(11, Vec3::UnitX())}));
  EXPECT_TRUE(blocked.add(std::vector{vertex_blockage(12, Vec3::UnitX())}));
}

TEST(BlockedWays, AreAddedOnceAStepForEachBody) {
  BlockedWays blocked = ways({blockage(Vec3::UnitZ()), blockage(Vec3::UnitX())});
  EXPECT_EQ(blocked.all().size(), 2U);
  EXPECT_FALSE(blocked.add(std::vector{blockage(Vec3::UnitY())})) << "what leads it round did not help";
  EXPECT_TRUE(blocked.add(std::vector{blockage(Vec3::UnitY(), Vec3::Zero(), 1)}));
  EXPECT_FALSE(blocked.add({}));
  blocked.start_step(kStep);
  EXPECT_TRUE(blocked.add(std::vector{blockage(Vec3::UnitY())}));
  EXPECT_EQ(blocked.all().size(), 4U);
}

}  // namespace selvage::sim
