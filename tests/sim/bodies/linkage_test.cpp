#include "sim/bodies/linkage.h"

#include <random>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace selvage {

using namespace sim;

namespace {

class RandomMotion {
 public:
  explicit RandomMotion(unsigned seed) : engine_(seed) {}
  double number(double from, double to) { return std::uniform_real_distribution<double>(from, to)(engine_); }
  Vec3 vector(double size) { return {number(-size, size), number(-size, size), number(-size, size)}; }
  Pose pose() { return {vector(1), vector(200)}; }
  RigidPath path() {
    std::vector<PoseKey> keys;
    double time_s = number(0, 0.5);
    for (int n = 0; n < 5; ++n, time_s += number(0.05, 0.5)) keys.push_back({time_s, pose()});
    return {keys, static_cast<Interpolation>(std::uniform_int_distribution<int>(0, 2)(engine_))};
  }

 private:
  std::mt19937 engine_;
};

Vec3 apply(const RigidFrame& frame, const Vec3& x) { return frame.turn * x + frame.position_m; }

}  // namespace

TEST(Linkage, WithoutParentAndPlacementTheBitsAreThePaths) {
  for (unsigned seed = 0; seed < 50; ++seed) {
    RandomMotion random(seed);
    const RigidPath path = random.path();
    const Linkage linkage({}, path);
    for (double t = 0; t < 3; t += 0.037) {
      const RigidFrame expected = frame_of(path.at(t));
      ASSERT_EQ(linkage.at(t).turn, expected.turn);
      ASSERT_EQ(linkage.at(t).position_m, expected.position_m);
    }
  }
}

TEST(Linkage, InItsParentsFrameAChildMovesAsItsOwnScriptSays) {
  for (unsigned seed = 0; seed < 50; ++seed) {
    RandomMotion random(seed);
    const Linkage root(random.pose(), random.path());
    const Linkage parent(random.pose(), random.path(), root);
    const Pose placement = random.pose();
    const RigidPath path = random.path();
    const Linkage child(placement, path, parent);
    const Vec3 x = random.vector(1);
    for (double t = 0; t < 3; t += 0.037) {
      const RigidFrame outer = parent.at(t), own = child.at(t);
      const Vec3 seen = outer.turn.transpose() * (apply(own, x) - outer.position_m);
      ASSERT_LT((seen - apply(frame_of(placement), apply(frame_of(path.at(t)), x))).norm(), 1e-13) << seed << " " << t;
      ASSERT_LT((own.turn.transpose() * own.turn - Eigen::Matrix3d::Identity()).norm(), 1e-13);
      ASSERT_GT(own.turn.col(0).cross(own.turn.col(1)).dot(own.turn.col(2)), 0.9) << "no reflection";
    }
  }
}

TEST(Linkage, AJointStaysOnItsParentWhileTheChildTurns) {
  RandomMotion random(7);
  const Linkage parent(random.pose(), random.path());
  const Vec3 joint = random.vector(1);
  std::vector<PoseKey> turns = {{0, {}}, {1, {Vec3::Zero(), {0, 90, 40}}}, {2, {Vec3::Zero(), {-30, 0, 300}}}};
  const Linkage child({joint, {20, 0, 0}}, RigidPath(turns, Interpolation::kSpline), parent);
  for (double t = 0; t < 3; t += 0.037) {
    ASSERT_LT((apply(child.at(t), Vec3::Zero()) - apply(parent.at(t), joint)).norm(), 1e-14);
  }
}

TEST(Linkage, AnArmOfTwoQuarterTurnsPointsBackwards) {
  const std::vector<PoseKey> bent = {{0, {Vec3::Zero(), {0, 0, 90}}}};
  const Linkage upper({{0, 0, 5}, Vec3::Zero()}, RigidPath(bent, Interpolation::kLinear));
  const Linkage lower({{2, 0, 0}, Vec3::Zero()}, RigidPath(bent, Interpolation::kLinear), upper);
  EXPECT_LT((apply(upper.at(0), {2, 0, 0}) - Vec3(0, 2, 5)).norm(), 1e-15) << "the elbow";
  EXPECT_LT((apply(lower.at(0), {1, 0, 0}) - Vec3(-1, 2, 5)).norm(), 1e-15) << "the hand";
}

TEST(Linkage, TurnsByWhatAllItHangsOnTurns) {
  const std::vector<PoseKey> turns = {{0, {}}, {1, {Vec3::Zero(), {0, 0, 720}}}};
  const RigidPath turning(turns, Interpolation::kLinear), rest({{0, {}}}, Interpolation::kLinear);
  const Linkage at_rest({}, rest), spinning({}, turning);
  EXPECT_EQ(Linkage({}, turning, at_rest).turn_deg(0, 1), 720);
  EXPECT_EQ(Linkage({}, rest, spinning).turn_deg(0, 1), 720);
  EXPECT_EQ(Linkage({}, turning, spinning).turn_deg(0.25, 0.5), 360);
}

}  // namespace selvage
