#include "sim/dynamics/lost_loads.h"

#include <gtest/gtest.h>

namespace selvage::sim {
namespace {

/// Triangles of three vertices each: three of cloth, then the ground under them all.
class LostLoads : public ::testing::Test {
 protected:
  static Mesh triangles() {
    Faces F(4, 3);
    for (int k = 0; k < 4; ++k) F.row(k) << 3 * k, 3 * k + 1, 3 * k + 2;
    return make_mesh(12, F);
  }
  /// What is left, without room at `vertex`.
  ContactLoads left(VertexId vertex, const Candidates& pressed = {}) const {
    ContactLoads loads = loads_;
    forget_loads(std::vector<VertexId>{vertex}, pressed, mesh_, SurfaceParts(mesh_), 9, loads);
    return loads;
  }

  const Mesh mesh_ = triangles();
  // The first and the third lie on the ground; an edge of the second on the first.
  const ContactLoads loads_{{{0, 3, 1.0}, {6, 3, 2.0}}, {{0, 3, 3.0}}};
};

}  // namespace

TEST_F(LostLoads, NoneWhereAllHadRoom) {
  ContactLoads loads = loads_;
  forget_loads({}, {}, mesh_, SurfaceParts(mesh_), 9, loads);
  EXPECT_EQ(loads, loads_);
  forget_loads(std::vector<VertexId>{9}, {}, mesh_, SurfaceParts(mesh_), 9, loads);
  EXPECT_EQ(loads, loads_) << "the ground is no cloth";
}

TEST_F(LostLoads, OfWhatHangsTogetherButNotThroughABody) {
  const ContactLoads third{{{6, 3, 2.0}}, {}};
  EXPECT_EQ(left(1), third);
  EXPECT_EQ(left(5), third) << "the second bears on the first";
  EXPECT_EQ(left(8), (ContactLoads{{{0, 3, 1.0}}, {{0, 3, 3.0}}})) << "the ground joins nothing";
}

TEST_F(LostLoads, OfWhatPressesWithoutALoad) {
  EXPECT_TRUE(left(8, {{{4, 2}}, {}}).empty()) << "a vertex of the second on the third";
  EXPECT_TRUE(left(1, {{}, {{4, 7}}}).empty()) << "edges of the second and the third";
}

}  // namespace selvage::sim
