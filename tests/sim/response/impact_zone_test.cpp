#include "sim/response/impact_zone.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace selvage::sim::testbed {
namespace {

/// Eight vertices on a line; 6 belongs to body 0 and moves, 7 to body 1 and rests.
struct ZoneScene {
  std::vector<double> inverse_mass{1, 1, 1, 1, 1, 1, 0, 0};
  std::vector<std::int32_t> body{-1, -1, -1, -1, -1, -1, 0, 1};
  ScriptedGroups groups{CollisionBodies{inverse_mass, body, SqueezePolicy::kStop}};
  StepMotion motion;
  ZoneScene() {
    Positions V_t0 = Positions::Zero(8, 3);
    for (Eigen::Index v = 0; v < 8; ++v) V_t0(v, 0) = static_cast<double>(v);
    Positions V_t1 = V_t0;
    for (Eigen::Index v = 0; v < 6; ++v) V_t1(v, 2) = v % 2 == 0 ? 1 : -1;
    V_t1(6, 2) = 5;
    motion.start(V_t0, V_t1, Precision::kFloat64);
    groups.observe(motion);
  }
};

}  // namespace

TEST(ImpactZones, MergingIsTransitive) {
  const ZoneScene scene;
  ImpactZones zones(8, scene.groups);
  EXPECT_TRUE(zones.merge({5, 4, 5, 4}));
  EXPECT_TRUE(zones.merge({0, 1, 2, 2}));
  EXPECT_FALSE(zones.merge({2, 1, 0, 1}));  // one zone already
  EXPECT_TRUE(zones.merge({2, 3, 4, 3}));   // joins both zones and vertex 3
  EXPECT_TRUE(std::ranges::is_permutation(zones.members(zones.zone(0)), std::vector<VertexId>{0, 1, 2, 3, 4, 5}));
  for (VertexId v = 0; v < 6; ++v) EXPECT_EQ(zones.zone(v), zones.zone(0));
  EXPECT_EQ(zones.largest(), 6);
}

TEST(ImpactZones, MoveByTheirMomentumAndLeaveOthersAlone) {
  ZoneScene scene;
  ImpactZones zones(8, scene.groups);
  const Positions before = scene.motion.displacement();
  ASSERT_TRUE(zones.merge({1, 2, 3, 3}));
  zones.move_grown(before, scene.inverse_mass, scene.motion);
  const Positions& after = scene.motion.displacement();
  for (const VertexId v : {0, 4, 5, 6, 7}) EXPECT_EQ(after.row(v), before.row(v));
  // Momenta -1, 1, -1: together -1/3 a vertex; about the middle node they have no angular momentum.
  for (const VertexId v : {1, 2, 3}) EXPECT_NEAR(after(v, 2), -1.0 / 3, 1e-15);
}

TEST(ImpactZones, FollowTheScriptTheyHold) {
  ZoneScene scene;
  ImpactZones zones(8, scene.groups);
  ASSERT_TRUE(zones.merge({5, 6, 5, 6}));  // the moving body
  ASSERT_TRUE(zones.merge({0, 7, 0, 7}));  // the resting one
  zones.move_grown(scene.motion.displacement(), scene.inverse_mass, scene.motion);
  EXPECT_EQ(scene.motion.displacement().row(5), Eigen::RowVector3d(0, 0, 5));
  EXPECT_EQ(scene.motion.x().row(0), scene.motion.V_t0().row(0));
  EXPECT_EQ(scene.motion.x().row(6), Eigen::RowVector3d(6, 0, 5));  // the script itself is not touched
}

TEST(ImpactZones, DoNotJoinTwoScriptsThatMoveDifferently) {
  ZoneScene scene;
  ImpactZones zones(8, scene.groups);
  ASSERT_TRUE(zones.merge({5, 6, 5, 6}));
  EXPECT_FALSE(zones.merge({5, 4, 7, 7}));
  EXPECT_FALSE(zones.merge({3, 6, 7, 7}));
  EXPECT_EQ(zones.zone(3), 3);
  EXPECT_TRUE(zones.merge({4, 7, 4, 7}));
  EXPECT_FALSE(zones.merge({4, 5, 4, 5}));  // would join them through cloth
}

TEST(ImpactZones, TakeBodiesAtRestForOneScript) {
  const std::vector<double> inverse_mass{1, 0, 0};
  const std::vector<std::int32_t> body{-1, 0, 1};
  ScriptedGroups groups{CollisionBodies{inverse_mass, body}};
  StepMotion motion;
  const Positions V = Positions::Random(3, 3);
  motion.start(V, V + Positions::Constant(3, 3, 0.5).cwiseProduct(Eigen::Vector3d::UnitX().replicate(1, 3)),
               Precision::kFloat64);
  groups.observe(motion);
  ImpactZones zones(3, groups);
  EXPECT_TRUE(zones.merge({0, 1, 2, 2}));
  zones.move_grown(motion.displacement(), inverse_mass, motion);
  EXPECT_EQ(motion.x(), V) << "what holds both stays";
}

TEST(ImpactZones, WeighTheirVerticesByMass) {
  ZoneScene scene;
  scene.inverse_mass = {1, 1, 0.5, 0.25, 1, 1, 0, 0};
  ImpactZones zones(8, scene.groups);
  const Positions before = scene.motion.displacement();
  ASSERT_TRUE(zones.merge({1, 2, 3, 3}));
  zones.move_grown(before, scene.inverse_mass, scene.motion);
  const auto momentum = [&](const Positions& displacement) -> Eigen::RowVector3d {
    return displacement.row(1) + 2 * displacement.row(2) + 4 * displacement.row(3);
  };
  EXPECT_LT((momentum(scene.motion.displacement()) - momentum(before)).norm(), 1e-14);
}

// Positions are stored as the lattice can say them; displacements, and with them velocities, are as near the origin.
TEST(ImpactZones, KeepLinearMomentumFarFromTheOrigin) {
  const std::vector<double> inverse_mass{1e6, 1, 30, 1e3, 1, 1e4, 0, 0};
  for (const double distance : {0.0, 1e3, 1e6, 1e9}) {
    ZoneScene scene;
    Positions V_t0(8, 3), V_t1(8, 3);
    for (Eigen::Index v = 0; v < 8; ++v) {
      const auto k = static_cast<double>(v);
      V_t0.row(v) << distance + std::sin(k), distance / 3 + std::cos(2 * k), std::sin(3 * k) - distance;
      const double speed = v == 0 ? 1 : 1e-3;  // the lightest is the fastest
      V_t1.row(v) = V_t0.row(v) + speed * Eigen::RowVector3d(std::cos(5 * k), std::sin(7 * k), std::cos(11 * k));
    }
    scene.motion.start(V_t0, V_t1, Precision::kFloat64);
    ImpactZones zones(8, scene.groups);
    const Positions before = scene.motion.displacement();
    ASSERT_TRUE(zones.merge({0, 1, 2, 3}));
    ASSERT_TRUE(zones.merge({3, 4, 5, 5}));
    zones.move_grown(before, inverse_mass, scene.motion);
    const Positions& after = scene.motion.displacement();
    Eigen::RowVector3d gained = Eigen::RowVector3d::Zero();
    double scale = 0;
    for (Eigen::Index v = 0; v < 6; ++v) {
      const double mass = 1 / inverse_mass[static_cast<std::size_t>(v)];
      gained += mass * (after.row(v) - before.row(v));
      scale += mass * before.row(v).norm();
    }
    EXPECT_LE(gained.norm(), 1e-13 * scale) << distance;
    const double ulp = 2.3e-16 * (distance + 2);
    for (Eigen::Index v = 0; v < 6; ++v) {
      for (Eigen::Index w = 0; w < v; ++w) {
        const double length_t0 = (V_t0.row(v) - V_t0.row(w)).norm();
        const double length_t1 = (scene.motion.x().row(v) - scene.motion.x().row(w)).norm();
        EXPECT_NEAR(length_t1, length_t0, 2 * ulp) << distance;
      }
    }
  }
}

// A zone that grows takes the motion from before all zones: by the last one it would have lost what a chord loses.
TEST(ImpactZones, GrowAsIfTheyHadBeenMergedAtOnce) {
  ZoneScene in_steps, at_once;
  const Positions before = in_steps.motion.displacement();
  ImpactZones growing(8, in_steps.groups), whole(8, at_once.groups);
  ASSERT_TRUE(growing.merge({0, 1, 1, 0}));
  growing.move_grown(before, in_steps.inverse_mass, in_steps.motion);
  ASSERT_TRUE(growing.merge({1, 2, 2, 1}));
  growing.move_grown(before, in_steps.inverse_mass, in_steps.motion);
  ASSERT_TRUE(whole.merge({0, 1, 2, 2}));
  whole.move_grown(before, at_once.inverse_mass, at_once.motion);
  EXPECT_EQ(in_steps.motion.x(), at_once.motion.x());
}

}  // namespace selvage::sim::testbed
