#include "sim/response/impact_zone.h"

#include <algorithm>

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

}  // namespace selvage::sim::testbed
