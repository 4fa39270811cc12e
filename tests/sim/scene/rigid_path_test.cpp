#include "sim/scene/rigid_path.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "sim/bodies/collider.h"
#include "sim/scene/shapes.h"

namespace selvage {

using namespace sim;

namespace {

const std::vector<PoseKey> kKeys = {{0.5, {{0.1, 0.2, 0.3}, {0, 0, 0}}},
                                    {0.7, {{1.1, -0.3, 0.7}, {10, 200, -35}}},
                                    {1.9, {{0.1, 0.9, 0.3}, {0, 0, 720}}}};

}  // namespace

TEST(RigidPath, MeetsItsKeysBitForBit) {
  for (const Interpolation interpolation : {Interpolation::kLinear, Interpolation::kSmooth, Interpolation::kSpline}) {
    const RigidPath path(kKeys, interpolation);
    for (const PoseKey& key : kKeys) {
      EXPECT_EQ(path.at(key.time_s).position_m, key.pose.position_m);
      EXPECT_EQ(path.at(key.time_s).rotation_deg, key.pose.rotation_deg);
    }
    EXPECT_EQ(path.at(0).position_m, kKeys.front().pose.position_m);
    EXPECT_EQ(path.at(99).rotation_deg, kKeys.back().pose.rotation_deg);
  }
}

TEST(RigidPath, LinearAndSmoothGoStraightFromEachKeyToTheNext) {
  for (const auto& [interpolation, share] :
       {std::pair(Interpolation::kLinear, 0.25), std::pair(Interpolation::kSmooth, 0.15625)}) {
    const RigidPath path(kKeys, interpolation);
    for (std::size_t i = 1; i < kKeys.size(); ++i) {
      const PoseKey &from = kKeys[i - 1], &to = kKeys[i];
      const Pose quarter = path.at(0.75 * from.time_s + 0.25 * to.time_s);
      const Vec3 x = (1 - share) * from.pose.position_m + share * to.pose.position_m,
                 turn = (1 - share) * from.pose.rotation_deg + share * to.pose.rotation_deg;
      EXPECT_LT((quarter.position_m - x).norm(), 1e-14) << i;
      EXPECT_LT((quarter.rotation_deg - turn).norm(), 1e-11) << i;
    }
  }
}

TEST(RigidPath, SmoothStandsStillAtKeysAndLinearDoesNot) {
  const double h = 1e-4;
  const auto speed = [&](Interpolation interpolation, double time_s) {
    const RigidPath path(kKeys, interpolation);
    return (path.at(time_s + h).position_m - path.at(time_s).position_m).norm() / h;
  };
  EXPECT_LT(speed(Interpolation::kSmooth, 0.5), 0.02);
  EXPECT_LT(speed(Interpolation::kSmooth, 0.7), 0.02);
  EXPECT_GT(speed(Interpolation::kLinear, 0.5), 1);
}

namespace {

// How much faster the position changes after the time than before it, m/s.
double velocity_jump(const RigidPath& path, double time_s) {
  const double h = 1e-6;
  const Vec3 before = path.at(time_s).position_m - path.at(time_s - h).position_m;
  const Vec3 after = path.at(time_s + h).position_m - path.at(time_s).position_m;
  return (after - before).norm() / h;
}

}  // namespace

TEST(RigidPath, SplineHasNoJumpInVelocityAndRestsAtItsEnds) {
  std::vector<PoseKey> keys = kKeys;
  keys.push_back({2.2, {{0.4, 0.4, 0.4}, {5, 5, 5}}});
  const RigidPath spline(keys, Interpolation::kSpline), linear(keys, Interpolation::kLinear);
  for (const PoseKey& key : keys) {
    EXPECT_LT(velocity_jump(spline, key.time_s), 1e-3) << key.time_s;
    EXPECT_GT(velocity_jump(linear, key.time_s), 0.5) << key.time_s;
  }
  for (const double end_s : {0.5, 2.2}) {
    EXPECT_LT((spline.at(end_s + 1e-6).position_m - spline.at(end_s - 1e-6).position_m).norm(), 1e-9);
  }
  EXPECT_GT((spline.at(0.7 + 1e-6).position_m - spline.at(0.7 - 1e-6).position_m).norm(), 1e-7) << "no stop at a key";
}

TEST(RigidPath, SplineKeepsAConstantVelocity) {
  const Vec3 v(1, -2, 0.5), w(10, 40, -70);
  std::vector<PoseKey> keys;
  for (const double t : {0.0, 0.1, 0.4, 1.0, 1.1, 2.0}) keys.push_back({t, {t * v, t * w}});
  const RigidPath path(keys, Interpolation::kSpline);
  for (double t = 0.1; t < 1.1; t += 0.013) {
    EXPECT_LT((path.at(t).position_m - t * v).norm(), 1e-14);
    EXPECT_LT((path.at(t).rotation_deg - t * w).norm(), 1e-12);
  }
}

TEST(RigidPath, SaysHowFarItTurnsAndWhereItMayBend) {
  const RigidPath path(kKeys, Interpolation::kLinear);
  EXPECT_EQ(path.keys_between(0, 1.9), (std::vector<double>{0.5, 0.7}));
  EXPECT_EQ(path.turn_deg(0, 0.5), 0);
  EXPECT_NEAR(path.turn_deg(0.5, 0.7), Vec3(10, 200, -35).norm(), 1e-12);
  EXPECT_NEAR(path.turn_deg(0.6, 1.9), Vec3(5, 100, -17.5).norm() + Vec3(-10, -200, 755).norm(), 1e-10);
}

// Between its first two keys this one turns back by 3,413 degrees, and comes again.
TEST(RigidPath, ASplineTurnsNoFartherThanItSays) {
  const Vec3 none = Vec3::Zero();
  const RigidPath path({{0, {}}, {1, {}}, {2, {none, {0, 0, 46080}}}, {3, {none, {90, 0, 0}}}}, Interpolation::kSpline);
  for (const auto& [t0_s, t1_s] : {std::pair(0.0, 1.0), {0.0, 0.5}, {0.3, 0.31}, {-1.0, 0.2}, {0.5, 2.5}, {2.9, 4.0}}) {
    constexpr int kPieces = 10'000;
    double way_deg = 0;
    Vec3 from = path.at(t0_s).rotation_deg;
    for (int piece = 1; piece <= kPieces; ++piece) {
      const Vec3 to = path.at(t0_s + (t1_s - t0_s) * piece / kPieces).rotation_deg;
      way_deg += (to - from).norm();
      from = to;
    }
    EXPECT_GT(way_deg, 1) << t0_s << " to " << t1_s << " s";
    EXPECT_GE(path.turn_deg(t0_s, t1_s), (1 - 1e-9) * way_deg) << t0_s << " to " << t1_s << " s";
    EXPECT_LE(path.turn_deg(t0_s, t1_s), 2.5 * way_deg) << t0_s << " to " << t1_s << " s";
  }
  EXPECT_EQ(path.turn_deg(-2, 0), 0);
  EXPECT_EQ(path.turn_deg(3, 5), 0);
  const Collider blade("blade", {0}, Collider::Rigid{Eigen::RowVector3d(1, 0, 0), Linkage({}, path)});
  EXPECT_EQ(blade.bend(0, 1).leaves_line_by_m, std::numeric_limits<double>::infinity());
}

TEST(Collider, KnowsHowFarItLeavesStraightLines) {
  const auto on = [](std::vector<PoseKey> keys, const Vec3& vertex) {
    return Collider(
        "body", {0},
        Collider::Rigid{vertex.transpose(), Linkage({}, RigidPath(std::move(keys), Interpolation::kLinear))});
  };
  const Vec3 vertex(2, 0, 0), none = Vec3::Zero();
  const Collider turning = on({{0, {}}, {1, {none, {0, 0, 60}}}}, vertex);
  EXPECT_NEAR(turning.bend(0, 1).leaves_line_by_m, 2 * (1 - std::sqrt(0.75)), 1e-15);
  EXPECT_NEAR(turning.bend(0, 0.5).leaves_line_by_m, 2 * (1 - std::cos(std::acos(-1) / 12)), 1e-15);
  EXPECT_EQ(turning.bend(1, 2).leaves_line_by_m, 0);
  EXPECT_EQ(on({{0, {}}, {1, {none, {0, 0, 360}}}}, vertex).bend(0, 1).leaves_line_by_m,
            std::numeric_limits<double>::infinity());
  // There and back between the quarters; and along one line at two speeds, which leaves nothing out.
  EXPECT_NEAR(on({{0, {}}, {0.1, {{0, 0, 3}, none}}, {0.2, {}}}, vertex).bend(0, 1).leaves_line_by_m, 3, 1e-15);
  EXPECT_EQ(on({{0, {}}, {0.1, {{0, 0, 3}, none}}, {1, {{0, 0, 4}, none}}}, vertex).bend(0, 1).leaves_line_by_m, 0);
  // Of those two speeds the first brings it to 3, where it would be at 0.4 in an even motion.
  EXPECT_NEAR(on({{0, {}}, {0.1, {{0, 0, 3}, none}}, {1, {{0, 0, 4}, none}}}, vertex).bend(0, 1).off_by_m, 2.6, 1e-15);
  // At quarters of the time it is always where it began; it turns by more than is looked at.
  const Eigen::AlignedBox3d four_turns = on({{0, {}}, {1, {none, {0, 0, 1440}}}}, vertex).bend(0, 1).within;
  EXPECT_TRUE(four_turns.contains(Eigen::AlignedBox3d(Vec3(-2, -2, 0), Vec3(2, 2, 0))));
  EXPECT_LT(four_turns.diagonal().norm(), 30);
  const Eigen::AlignedBox3d any_turns = on({{0, {}}, {1, {none, {0, 0, 1e9}}}}, vertex).bend(0, 1).within;
  EXPECT_TRUE(any_turns.contains(Vec3(-2, 0, 0)));
}

TEST(RigidPath, IsRigidAtAllTimes) {
  const RigidPath path(kKeys, Interpolation::kSpline);
  const Shape box = make_box({1, 2, 3}, 1);
  for (double t = 0.4; t < 2; t += 0.03) {
    const Positions placed = place(path.at(t), box.x);
    for (Eigen::Index i = 0; i < placed.rows(); ++i) {
      for (Eigen::Index j = 0; j < i; ++j) {
        EXPECT_NEAR((placed.row(i) - placed.row(j)).norm(), (box.x.row(i) - box.x.row(j)).norm(), 1e-14);
      }
    }
  }
}

TEST(RigidPath, TurnsTheRightWay) {
  Positions x(1, 3);
  x << 1, 0, 0;
  const Positions turned = place({{0, 0, 5}, {0, 0, 90}}, x);
  EXPECT_NEAR((turned - Positions(Eigen::RowVector3d(0, 1, 5))).norm(), 0, 1e-15);
}

TEST(RigidPath, WithoutRotationPlacementIsAPlainSum) {
  const Shape sphere = make_sphere(0.3, 2);
  EXPECT_EQ(place({}, sphere.x), sphere.x);
  EXPECT_EQ(place({{0.1, 0.2, 0.3}, {0, 0, 0}}, sphere.x),
            Positions(sphere.x.rowwise() + Eigen::RowVector3d(0.1, 0.2, 0.3)));
}

TEST(Collider, FollowsItsScriptExactlyAndLiesOnTheLattice) {
  const Shape sphere = make_sphere(0.3, 1);
  std::vector<VertexId> vertices;
  for (VertexId i = 0; i < sphere.x.rows(); ++i) vertices.push_back(i + 2);
  const Collider collider("ball", vertices,
                          Collider::Rigid{sphere.x, Linkage({}, RigidPath(kKeys, Interpolation::kLinear))}, 1.5);
  Positions x = Positions::Constant(sphere.x.rows() + 3, 3, 7);
  collider.place_at(0.7, sim::Precision::kFloat64, x);
  EXPECT_EQ(Positions(x.middleRows(2, sphere.x.rows())), place(kKeys[1].pose, sphere.x));
  EXPECT_EQ(Positions(x.topRows(2)), Positions::Constant(2, 3, 7));
  EXPECT_EQ(Positions(x.bottomRows(1)), Positions::Constant(1, 3, 7));
  collider.place_at(0.7, sim::Precision::kFloat32, x);
  EXPECT_EQ(x, Positions(x.cast<float>().cast<double>()));
  EXPECT_NE(Positions(x.middleRows(2, sphere.x.rows())), place(kKeys[1].pose, sphere.x));
  EXPECT_TRUE(collider.holds(1.4999));
  EXPECT_FALSE(collider.holds(1.5));
}

}  // namespace selvage
