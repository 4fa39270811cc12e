// Parts laid flat, judged by the exact checker.
#include "sim/repair/flat_layout.h"

#include <cmath>
#include <numeric>
#include <random>

#include <Eigen/Geometry>

#include "tests/sim/step_scene.h"

namespace selvage::sim::testbed {
namespace {

Region all_of(const StepScene& scene) {
  Region part(static_cast<std::size_t>(scene.V_t0.rows()));
  std::iota(part.begin(), part.end(), 0);
  return part;
}

std::optional<FlatLayout> lay_flat(const StepScene& scene, const Region& part, const Positions& x) {
  const Mesh mesh = scene.mesh();
  return flat_layout(mesh, neighbours_of(mesh), part, scene.V_t0, x);
}

std::optional<FlatLayout> lay_flat(const StepScene& scene) { return lay_flat(scene, all_of(scene), scene.V_t0); }

/// Without the faces of the middle `hole` by `hole` cells, an even number of as many as `cells` by `cells`.
Shape sheet_with_hole(std::int32_t cells, std::int32_t hole) {
  const Shape whole = make_sheet(cells + 1, cells + 1, 1, 1);
  Shape shape{whole.x, {}};
  const double half = 0.5 * hole / cells;
  for (const auto& t : whole.triangles) {
    const Eigen::RowVector3d middle = (whole.x.row(t[0]) + whole.x.row(t[1]) + whole.x.row(t[2])) / 3;
    if (middle.cwiseAbs().maxCoeff() > half) shape.triangles.push_back(t);
  }
  return shape;
}

/// Everything anywhere within a metre.
void scatter(StepScene& scene) {
  std::mt19937 engine(1);
  for (Eigen::Index v = 0; v < scene.V_t0.rows(); ++v) {
    for (int axis = 0; axis < 3; ++axis) scene.V_t0(v, axis) = double(engine()) * 0x1p-32;
  }
}

/// In a plane at right angles to `across`, to rounding, and free of intersections.
void expect_flat(const StepScene& scene, const FlatLayout& flat) {
  EXPECT_EQ(flat.vertices, all_of(scene));
  EXPECT_NEAR(flat.across.norm(), 1, 1e-12);
  const Eigen::VectorXd heights = flat.x * flat.across;
  EXPECT_LT(heights.maxCoeff() - heights.minCoeff(), 1e-12);
  EXPECT_EQ(exact_defect(scene, flat.x), "");
}

double perimeter(const FlatLayout& flat, const std::vector<VertexId>& loop) {
  double sum = 0;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    sum += (flat.x.row(loop[i]) - flat.x.row(loop[(i + 1) % loop.size()])).norm();
  }
  return sum;
}

}  // namespace

TEST(FlatLayout, OfASheetWhoseVerticesAreAnywhere) {
  for (const std::int32_t side : {2, 3, 4, 9, 20}) {
    SCOPED_TRACE(side);
    StepScene scene;
    scene.add(make_sheet(side, side + 1, 1, 1), Vec3::Zero());
    scatter(scene);
    const std::optional<FlatLayout> flat = lay_flat(scene);
    ASSERT_TRUE(flat);
    expect_flat(scene, *flat);
  }
}

TEST(FlatLayout, OfASheetWithAHoleWhoseRimIsWithin) {
  StepScene scene;
  scene.add(sheet_with_hole(8, 4), Vec3::Zero());
  const Region ring = [&] {
    Region found;
    for (const VertexId v : all_of(scene)) {
      if (scene.mesh().vertex_owner[static_cast<std::size_t>(v)] >= 0) found.push_back(v);
    }
    return found;
  }();
  ASSERT_LT(ring.size(), static_cast<std::size_t>(scene.V_t0.rows())) << "the middle of the hole is in no face";
  scatter(scene);
  const std::optional<FlatLayout> flat = lay_flat(scene, ring, scene.V_t0);
  ASSERT_TRUE(flat);
  EXPECT_EQ(flat->vertices, ring);
  Positions x = scene.V_t0;
  for (std::size_t i = 0; i < ring.size(); ++i) x.row(ring[i]) = flat->x.row(static_cast<Eigen::Index>(i));
  EXPECT_EQ(exact_defect(scene, x), "");
}

TEST(FlatLayout, IsWhereAndAsLargeAsThePartIs) {
  StepScene scene;
  scene.add(make_sheet(9, 9, 1, 1), Vec3(5, 6, 7));
  const std::optional<FlatLayout> flat = lay_flat(scene);
  ASSERT_TRUE(flat);
  EXPECT_NEAR(std::abs(flat->across.z()), 1, 1e-12);
  EXPECT_LT((flat->x.colwise().mean() - Eigen::RowVector3d(5, 6, 7)).norm(), 1e-9);
  EXPECT_LT((flat->x - scene.V_t0).rowwise().norm().maxCoeff(), 0.2) << "turned and over as the sheet is";
  std::vector<VertexId> loop;
  for (VertexId i = 0; i < 8; ++i) loop.push_back(i);
  for (VertexId i = 0; i < 8; ++i) loop.push_back(8 + 9 * i);
  for (VertexId i = 0; i < 8; ++i) loop.push_back(80 - i);
  for (VertexId i = 0; i < 8; ++i) loop.push_back(72 - 9 * i);
  EXPECT_NEAR(perimeter(*flat, loop), 4, 0.02);
}

/// Seen from above or from below, and turned about any axis: the border goes the least way.
TEST(FlatLayout, IsTurnedAsThePartIs) {
  StepScene scene;
  scene.add(make_sheet(9, 9, 1, 1), Vec3::Zero());
  for (const double angle : {0.3, 1.0, 2.0, 3.0, 4.5}) {
    for (const Vec3& axis : {Vec3(0, 0, 1), Vec3(1, 0, 0), Vec3(0.6, 0, 0.8)}) {
      const Eigen::Matrix3d turn = Eigen::AngleAxis<double>(angle, axis).toRotationMatrix();
      const Positions x = scene.V_t0 * turn.transpose();
      const std::optional<FlatLayout> flat = lay_flat(scene, all_of(scene), x);
      ASSERT_TRUE(flat);
      EXPECT_LT((flat->x - x).rowwise().norm().maxCoeff(), 0.2) << angle << " about " << axis.transpose();
    }
  }
}

TEST(FlatLayout, OfWhatLiesInALineOrAtOnePoint) {
  StepScene scene;
  scene.add(make_sheet(6, 6, 1, 1), Vec3::Zero());
  for (const Vec3& kept : {Vec3(1, 0, 0), Vec3(0, 0, 0)}) {
    const Positions x = scene.V_t0 * kept.asDiagonal();
    const std::optional<FlatLayout> flat = lay_flat(scene, all_of(scene), x);
    ASSERT_TRUE(flat) << "the lengths of the start are those of a sheet";
    expect_flat(scene, *flat);
  }
  scene.V_t0.setZero();
  EXPECT_FALSE(lay_flat(scene)) << "a border without length";
}

TEST(FlatLayout, OfNothingWithoutABorderOnItsOwn) {
  StepScene closed;
  closed.add(make_sphere(1, 1), Vec3::Zero());
  EXPECT_FALSE(lay_flat(closed));

  StepScene three_faces;
  Shape fins{Positions(5, 3), {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}}};
  fins.x << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, -1, 0;
  three_faces.add(fins, Vec3::Zero());
  EXPECT_FALSE(lay_flat(three_faces));

  StepScene finned;  // on an inner edge: the border is a loop all the same
  Shape fin = sheet(4);
  fin.x.conservativeResize(17, 3);
  fin.x.row(16) = fin.x.row(5) + Eigen::RowVector3d(0, 0, 1e-3);
  fin.triangles.push_back({5, 6, 16});
  finned.add(fin, Vec3::Zero());
  EXPECT_FALSE(lay_flat(finned));

  StepScene bow_tie;  // its border visits the middle twice
  Shape tie{Positions(5, 3), {{0, 1, 2}, {0, 3, 4}}};
  tie.x << 0, 0, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0, -1, -1, 0;
  bow_tie.add(tie, Vec3::Zero());
  EXPECT_FALSE(lay_flat(bow_tie));
}

/// Of the mesh, only the part counts.
TEST(FlatLayout, OfOnePartWhateverOthersAre) {
  StepScene scene;
  scene.add(make_sphere(1, 1), Vec3::Zero());
  const StepScene::Part sheet = scene.add(make_sheet(4, 4, 1, 1), Vec3(0, 0, 3));
  Region part(16);
  std::iota(part.begin(), part.end(), sheet.begin);
  const std::optional<FlatLayout> flat = lay_flat(scene, part, scene.V_t0);
  ASSERT_TRUE(flat);
  EXPECT_EQ(flat->vertices, part);
  EXPECT_EQ(flat->x.rows(), 16);
  EXPECT_NEAR(flat->x.col(2).minCoeff(), 3, 1e-9);
}

}  // namespace selvage::sim::testbed
