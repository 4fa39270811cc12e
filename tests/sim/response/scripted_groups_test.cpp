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

}  // namespace selvage::sim
