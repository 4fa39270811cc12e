// Bodies whose meshes have several vertices at one place, as STL files and seams of textures have, or faces cut in any
// way: cloth slides on them as on one surface.
#include <array>
#include <cmath>
#include <set>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "sim/description.h"
#include "sim/scene/shapes.h"
#include "sim/step.h"
#include "tests/sim/exact_step.h"
#include "tests/sim/small_scene.h"

namespace selvage::sim {
namespace {

constexpr double kThickness = 0.004;

Shape ground() { return make_sheet(9, 9, 3, 1.2); }

/// Every face has vertices of its own.
Shape soup_of(const Shape& shape) {
  Shape soup;
  soup.x.resize(3 * std::ssize(shape.triangles), 3);
  VertexId next = 0;
  for (const auto& face : shape.triangles) {
    soup.triangles.push_back({next, next + 1, next + 2});
    for (const VertexId corner : face) soup.x.row(next++) = shape.x.row(corner);
  }
  return soup;
}

/// The faces on one side of x = 0 have vertices of their own.
Shape split_at_middle(const Shape& shape) {
  const auto count = static_cast<VertexId>(shape.x.rows());
  Shape split{Positions(2 * count, 3), shape.triangles};
  split.x << shape.x, shape.x;
  for (auto& face : split.triangles) {
    const bool is_beyond = (shape.x.row(face[0]) + shape.x.row(face[1]) + shape.x.row(face[2]))[0] > 0;
    for (VertexId& corner : face) corner += is_beyond ? count : 0;
  }
  return split;
}

/// Beside each face one between two of its corners and a vertex at the place of the first.
Shape with_faces_without_area(const Shape& shape) {
  const auto count = static_cast<VertexId>(shape.x.rows());
  const auto face_count = static_cast<VertexId>(shape.triangles.size());
  Shape more{Positions(count + face_count, 3), shape.triangles};
  more.x.topRows(count) = shape.x;
  for (VertexId f = 0; f < face_count; ++f) {
    const auto face = shape.triangles[static_cast<std::size_t>(f)];
    more.x.row(count + f) = shape.x.row(face[0]);
    more.triangles.push_back({face[0], face[1], count + f});
  }
  return more;
}

/// Squares of 125 mm with a vertex within two of their sides, turned by 0.3; each split around its first corner, as
/// readers do, into one triangle without area and three others.
Shape turned_polygons() {
  constexpr VertexId kColumns = 24, kRows = 12;
  Shape ground;
  ground.x.resize(2 * (kColumns + 1) * (kRows + 1), 3);
  const auto corner = [](VertexId i, VertexId j) { return 2 * (j * (kColumns + 1) + i); };
  for (VertexId j = 0; j <= kRows; ++j) {
    for (VertexId i = 0; i <= kColumns; ++i) {
      for (const VertexId between : {0, 1}) {
        const double x = 0.125 * (i + 0.3 * between) - 1.5, y = 0.125 * j - 0.75;
        ground.x.row(corner(i, j) + between) << std::cos(0.3) * x - std::sin(0.3) * y,
            std::sin(0.3) * x + std::cos(0.3) * y, 0;
      }
      if (i == kColumns || j == kRows) continue;
      const VertexId a = corner(i, j), b = corner(i + 1, j), c = corner(i + 1, j + 1), d = corner(i, j + 1);
      for (const std::array<VertexId, 3>& face : {std::array{a, a + 1, b}, {a, b, c}, {a, c, d + 1}, {a, d + 1, d}}) {
        ground.triangles.push_back(face);
      }
    }
  }
  return ground;
}

/// Columns of bricks of 50 by 50 mm, every second one shifted: the corners within lie on one straight line each.
Shape bricks() {
  constexpr VertexId kColumns = 60, kRows = 24;
  Shape ground;
  ground.x.resize((kColumns + 1) * (kRows + 1), 3);
  for (VertexId i = 0; i <= kColumns; ++i) {
    for (VertexId j = 0; j <= kRows; ++j) {
      const VertexId a = i * (kRows + 1) + j, b = a + kRows + 1;
      ground.x.row(a) << 0.05 * i - 1.5, 0.05 * (j + 0.3 * (i % 2)) - 0.6, 0;
      if (i == kColumns || j == kRows) continue;
      ground.triangles.push_back({a, b, b + 1});
      ground.triangles.push_back({a, b + 1, a + 1});
    }
  }
  return ground;
}

std::string obj(const Shape& shape) {
  std::string text;
  for (const auto& v : shape.x.rowwise()) text += fmt::format("v {} {} {}\n", v[0], v[1], v[2]);
  for (const auto& f : shape.triangles) text += fmt::format("f {} {} {}\n", f[0] + 1, f[1] + 1, f[2] + 1);
  return text;
}

std::string start(const std::string& solver = "explicit") {
  return "solver = \"" + solver +
         "\"\ngravity_m_s2 = [0, 0, -9.81]\n[time]\nframes_per_s = 30\nduration_s = 0.5\n[collision]\n"
         "thickness_m = 0.004\n";
}

/// Edges of 33 mm; `place` says where, and how fast.
std::string sliding_sheet(const std::string& place) {
  return "[[cloth]]\nsheet = {nx = 10, ny = 10, width_m = 0.3, height_m = 0.3}\n" + place +
         "\ndensity_kg_m2 = 0.2\nstretch_n_m = 60\nshear_n_m = 20\nbend_n_m = 0.6\ndamping_ratio = 0.1\n";
}

class JoinedBodies : public ::testing::Test {
 protected:
  [[nodiscard]] Scene scene(const std::string& text) const {
    return testing::write_and_read_scene(folder_ / "scene.toml", text);
  }
  [[nodiscard]] World world_of(const Shape& body) const {
    testing::spit(folder_ / "body.obj", obj(body));
    return build_world(
        scene(start() + sliding_sheet("position_m = [0, 0, 1]") + "[[body]]\nmesh = {file = \"body.obj\"}\n"));
  }
  struct Way {
    Eigen::RowVector2d from_m{-0.6, 0.007}, v_m_s{2, 0.3};
    double duration_s = 0.5;
  };
  void slides_without_a_bump(const Shape& body, const std::string& solver = "explicit") const {
    slides_without_a_bump(body, solver, Way{});
  }
  void slides_without_a_bump(const Shape& body, const std::string& solver, const Way& way) const {
    testing::spit(folder_ / "body.obj", obj(body));
    Simulation simulation(scene(start(solver) +
                                sliding_sheet(fmt::format("position_m = [{}, {}, 0.0041]\nvelocity_m_s = [{}, {}, 0]",
                                                          way.from_m[0], way.from_m[1], way.v_m_s[0], way.v_m_s[1])) +
                                "[[body]]\nmesh = {file = \"body.obj\"}\n"));
    while (simulation.clock().time_s() < way.duration_s - 1e-9) simulation.step();
    const Positions x = simulation.x().topRows(100), v = simulation.state().v.topRows(100);
    EXPECT_LT((v.leftCols(2).rowwise() - way.v_m_s).rowwise().norm().maxCoeff(), 1e-3);
    EXPECT_GT(x.col(2).minCoeff(), 0.99 * kThickness);
    EXPECT_LT(x.col(2).maxCoeff(), 1.05 * kThickness);
  }

  testing::TemporaryFolder folder_;
};

}  // namespace

TEST_F(JoinedBodies, ASoupOfTrianglesIsOneSurface) {
  slides_without_a_bump(soup_of(ground()));
  slides_without_a_bump(soup_of(ground()), "implicit");
}

TEST_F(JoinedBodies, ASeamIsNotFelt) { slides_without_a_bump(split_at_middle(ground())); }

TEST_F(JoinedBodies, FacesBetweenVerticesOfOnePlaceAreNotFelt) {
  slides_without_a_bump(with_faces_without_area(ground()));
}

TEST_F(JoinedBodies, PolygonsWithAVertexWithinASideAreNotFelt) { slides_without_a_bump(turned_polygons()); }

TEST_F(JoinedBodies, BricksAreNotFelt) {
  // Where their corners were taken for lines the sheet was slowed to 3.3 to 3.5 m/s along x, and up to 18 mm high.
  slides_without_a_bump(bricks(), "explicit", {{-0.6, -0.3}, {3.5, 3.5}, 0.2});
}

TEST_F(JoinedBodies, VerticesKeepTheirNumbers) {
  const Shape soup = soup_of(ground());
  const World world = world_of(soup);
  EXPECT_EQ(world.x_t0.bottomRows(soup.x.rows()), soup.x);
  EXPECT_EQ(world.triangles.size() - world_of(ground()).triangles.size(), 0u);
  std::set<VertexId> of_a_face;
  for (const auto& face : world.triangles) of_a_face.insert(face.begin(), face.end());
  EXPECT_EQ(of_a_face.size(), 100u + 81u);
  EXPECT_EQ(world.triangles[162], (std::array<VertexId, 3>{100, 101, 102})) << "the first at a place";
}

/// A sequence of two frames, of the soup of a box; in the second its vertex `parted` may have moved.
TEST_F(JoinedBodies, OfASequenceOnlyWhatNeverParts) {
  const Shape box = make_box(Vec3(0.2, 0.2, 0.2), 1);
  Shape soup = soup_of(box);
  const auto used_by_body = [&] {
    const World world = build_world(scene(start() + sliding_sheet("position_m = [0, 0, 1]") +
                                          "[[body]]\nsequence = {file = \"frame_*.obj\", frames_per_s = 30}\n"));
    std::set<VertexId> of_a_face;
    for (const auto& face : world.triangles) {
      for (const VertexId corner : face) {
        if (corner >= world.cloth_vertex_count) of_a_face.insert(corner - world.cloth_vertex_count);
      }
    }
    return of_a_face;
  };
  testing::spit(folder_ / "frame_0.obj", obj(soup));
  testing::spit(folder_ / "frame_1.obj", obj(soup));
  EXPECT_EQ(used_by_body().size(), 8u);
  const VertexId parted = 35;
  ASSERT_FALSE(used_by_body().contains(parted));
  soup.x(parted, 0) += 0.01;
  testing::spit(folder_ / "frame_1.obj", obj(soup));
  EXPECT_EQ(used_by_body().size(), 9u);
  EXPECT_TRUE(used_by_body().contains(parted));
}

/// A wire: a face without area that is all there is of it.
TEST_F(JoinedBodies, ASegmentThatStandsAloneStopsCloth) {
  testing::spit(folder_ / "wire.obj", "v -1 0.003 0\nv 1 0.003 0\nv 1 0.003 -0\nf 1 2 3\n");
  Simulation simulation(
      scene(start() + sliding_sheet("position_m = [0, 0, 0.05]") + "[[body]]\nmesh = {file = \"wire.obj\"}\n"));
  testing::run_exactly_free(simulation, 15, [](const StepResult&) {});
  EXPECT_GT(simulation.x().middleRows(40, 20).col(2).minCoeff(), -0.05) << "the rows beside it, after 1.2 m of fall";
}

TEST_F(JoinedBodies, ARunSaysWhatWasJoined) {
  testing::spit(folder_ / "body.obj", obj(soup_of(ground())));
  const std::string text = start() + sliding_sheet("position_m = [0, 0, 1]");
  const Scene soup = scene(text + "[[body]]\nname = \"soup\"\nmesh = {file = \"body.obj\"}\n");
  EXPECT_NE(describe(soup, build_world(soup)).find("soup: 303 vertices joined"), std::string::npos)
      << describe(soup, build_world(soup));
  const Scene welded = scene(text + "[[body]]\nsheet = {nx = 2, ny = 2, width_m = 8, height_m = 8}\n");
  EXPECT_EQ(describe(welded, build_world(welded)).find("joined"), std::string::npos);
}

}  // namespace selvage::sim
