// Who waits, and that each call makes one more wait.
#include "sim/response/scripted_groups.h"

#include <vector>

#include <gtest/gtest.h>

namespace selvage::sim {
namespace {

/// A vertex of cloth, three of a rigid body 0, three of a body 1 that deforms, and a pin.
struct Bodies {
  std::vector<double> inverse_mass{1, 0, 0, 0, 0, 0, 0, 0};
  std::vector<std::int32_t> body{-1, 0, 0, 0, 1, 1, 1, -1};
  std::vector<std::uint8_t> deforms{0, 1};
  [[nodiscard]] ScriptedGroups groups() const {
    CollisionBodies bodies{inverse_mass, body};
    bodies.deforms = deforms;
    return ScriptedGroups(bodies);
  }
};

using Vertices = std::vector<VertexId>;
using Ids = std::vector<GroupId>;

}  // namespace

TEST(ScriptedGroups, RigidOnesWaitAsAWholeAndOthersVertexByVertexUntilNoneIsLeft) {
  ScriptedGroups groups = Bodies().groups();
  EXPECT_TRUE(groups.waiting_vertices().empty());
  groups.wait(Ids{0}, Vertices{0, 2});
  EXPECT_EQ(groups.waiting_vertices(), (Vertices{1, 2, 3}));
  groups.wait(Ids{1}, Vertices{5});
  EXPECT_EQ(groups.waiting_vertices(), (Vertices{1, 2, 3, 5}));
  groups.wait(Ids{1}, Vertices{5});
  EXPECT_EQ(groups.waiting_vertices(), (Vertices{1, 2, 3, 4, 5, 6})) << "the named one waits: all of its group";
  groups.wait(Ids{2}, Vertices{7});
  EXPECT_EQ(groups.waiting_vertices(), (Vertices{1, 2, 3, 4, 5, 6, 7}));
  EXPECT_EQ(groups.waiting_bodies(), (std::vector<std::int32_t>{-1, 0, 1}));
}

TEST(ScriptedGroups, AWaitThatMakesNobodyWaitIsABrokenInvariant) {
  ScriptedGroups groups = Bodies().groups();
  groups.wait(Ids{0, 1}, Vertices{4});
  EXPECT_DEATH(groups.wait(Ids{0}, Vertices{1}), "internal error");
  EXPECT_DEATH(groups.wait(Ids{}, Vertices{0}), "internal error") << "cloth does not wait";
  groups.wait(Ids{0, 1}, Vertices{4});  // the rest of 1
  EXPECT_DEATH(groups.wait(Ids{0, 1}, Vertices{4, 5, 6}), "internal error");
}

TEST(ScriptedGroups, ABodyOfWhichOneVertexMovesMoves) {
  ScriptedGroups groups = Bodies().groups();
  Positions V = Positions::Random(8, 3), V_t1 = V;
  V_t1(3, 0) += 1;
  StepMotion motion;
  motion.start(V, V_t1, Precision::kFloat64);
  groups.observe(motion);
  EXPECT_TRUE(groups.moves(0)) << "by its last vertex";
  EXPECT_FALSE(groups.moves(1));
  EXPECT_FALSE(groups.moves(2));
}

TEST(ScriptedGroups, WhatDeformsMovesCarriedClothAsTheVerticesThatItMeets) {
  ScriptedGroups groups = Bodies().groups();
  Positions V = Positions::Random(8, 3), V_t1 = V;
  V_t1.row(4) += Eigen::RowVector3d(0, 0, 1);
  V_t1.row(5) += Eigen::RowVector3d(0, 2, 0);
  StepMotion motion;
  motion.start(V, V_t1, Precision::kFloat64);
  groups.observe(motion);
  for (const VertexId near : {4, 5, 6}) {
    const Vec3 moved = groups.rigid_motion(1, motion, Vertices{0, near, 2, 0}).displacement(V.row(near));
    EXPECT_LT((moved.transpose() - (V_t1 - V).row(near)).norm(), 1e-15) << near;
  }
}

}  // namespace selvage::sim
