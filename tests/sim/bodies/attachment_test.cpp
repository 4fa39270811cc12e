// Pins that a body carries.
#include "sim/bodies/attachment.h"

#include <cmath>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "kernel/proximity.h"
#include "sim/scene/rigid_path.h"
#include "sim/scene/scene_reader.h"
#include "sim/scene/shapes.h"
#include "sim/step.h"
#include "tests/sim/exact_step.h"

namespace selvage::sim {
namespace {

/// Over the top of a ball of 0.1 m, within it, on a corner of its mesh, and far away.
Positions points_about(const Shape& ball) {
  Positions points(4, 3);
  points << 0.01, 0.02, 0.104, 0.03, 0, 0.05, 0, 0, 0, 2, -1, 3;
  points.row(2) = ball.x.row(7);
  return points;
}

}  // namespace

TEST(Attachment, OnABodyAtRestIsWhereItWasToTheBit) {
  const Shape ball = make_sphere(0.1, 2);
  const Positions points = points_about(ball);
  EXPECT_EQ(Attachment(points, ball.triangles, ball.x).placed_on(ball.x), points);
}

TEST(Attachment, TurnsAndMovesWithARigidBody) {
  const Shape ball = make_sphere(0.1, 2);
  const Positions points = points_about(ball);
  const Attachment attachment(points, ball.triangles, ball.x);
  for (const double turn_deg : {1e-6, 40.0, 179.0, 180.0, 300.0}) {
    const Pose pose{{5, -3, 2}, Vec3(0.6, 0, 0.8) * turn_deg};
    const Positions off = attachment.placed_on(place(pose, ball.x)) - place(pose, points);
    EXPECT_LT(off.cwiseAbs().maxCoeff(), 1e-12) << turn_deg;  // rounding of 5 m, at 40 edges' length from its face
  }
}

TEST(Attachment, GoesWithTheSurfaceOfABodyThatDeformsAndKeepsItsDistance) {
  const io::Triangles faces{{0, 1, 2}, {1, 3, 2}};
  Positions x(4, 3), stretched(4, 3);
  x << 0, 0, 0, 3, 0, 0, 0, 3, 0, 3, 3, 0;
  stretched << 0, 0, 1, 6, 0, 1, 0, 3, 1, 6, 3, 1;  // twice as long along x
  const Positions placed = Attachment(Positions(Eigen::RowVector3d(1, 0.5, 0.2)), faces, x).placed_on(stretched);
  EXPECT_LT((placed - Positions(Eigen::RowVector3d(2, 0.5, 1.2))).norm(), 1e-14);
  Positions bent = x;
  bent.row(3) << 0, 3, 3;  // the other face, to which it does not belong
  EXPECT_EQ(Attachment(Positions(Eigen::RowVector3d(1, 0.5, 0.2)), faces, x).placed_on(bent),
            Positions(Eigen::RowVector3d(1, 0.5, 0.2)));
}

TEST(Attachment, IsToTheNearestFace) {
  const Shape box = make_box(Vec3(1, 1, 1), 5);
  Positions points(1, 3), opened = box.x;
  points << 0.13, -0.21, 0.51;
  for (Eigen::Index v = 0; v < opened.rows(); ++v) {
    if (opened(v, 2) == 0.5) opened(v, 2) = 0.75;  // the top alone rises
  }
  const Positions placed = Attachment(points, box.triangles, box.x).placed_on(opened);
  EXPECT_LT((placed - Positions(Eigen::RowVector3d(0.13, -0.21, 0.76))).norm(), 1e-15);

  // Over the corner of a large face, and nearer to the middle of a small one.
  Positions x(6, 3);
  x << 0.9, 0, 0.35, 0.91, 0, 0.35, 0.9, 0.01, 0.35, 0, 0, 0, 1, 0, 0, 0, 1, 0;
  const Positions point(Eigen::RowVector3d(0.9, 0.01, 0.05));
  Positions moved = x;
  moved.bottomRows(3).col(0).array() += 1;
  EXPECT_EQ(Attachment(point, io::Triangles{{0, 1, 2}, {3, 4, 5}}, x).placed_on(moved)(0, 0), 1.9);
}

// Faces of all sizes, so that the balls about them overlap: the one that is looked at first is seldom the nearest.
TEST(Attachment, IsToTheNearestOfManyFaces) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(-1, 1), size(0.01, 1);
  io::Triangles faces;
  Positions x(3 * 40, 3), points(500, 3);
  for (std::int32_t f = 0; f < 40; ++f) {
    const Eigen::RowVector3d middle(place(random), place(random), place(random));
    const double extent = size(random);
    for (std::int32_t k = 0; k < 3; ++k) {
      x.row(3 * f + k) = middle + extent * Eigen::RowVector3d(place(random), place(random), place(random));
    }
    faces.push_back({3 * f, 3 * f + 1, 3 * f + 2});
  }
  for (Eigen::Index i = 0; i < points.rows(); ++i) points.row(i) << place(random), place(random), place(random);
  const Attachment attachment(points, faces, x);
  for (std::int32_t f = 0; f < 40; ++f) {
    Positions moved = x;
    moved.middleRows(3 * f, 3).rowwise() += Eigen::RowVector3d(10, 0, 0);
    const Positions placed = attachment.placed_on(moved);
    for (Eigen::Index i = 0; i < points.rows(); ++i) {
      const auto distance = [&](std::int32_t face) {
        return vf_proximity(
                   {Vec3(points.row(i)), Vec3(x.row(3 * face)), Vec3(x.row(3 * face + 1)), Vec3(x.row(3 * face + 2))})
            .distance;
      };
      if (placed(i, 0) < points(i, 0) + 5) continue;
      for (std::int32_t other = 0; other < 40; ++other) EXPECT_LE(distance(f), distance(other)) << i;
    }
  }
}

namespace {

/// Cloth that hangs behind a box, which moves and turns; the box hangs on another.
const std::string kCape = R"(
gravity_m_s2 = [0, 0, -9.81]
[time]
frames = 20
[collision]
thickness_m = 0.004
friction_static = 0.3
[[cloth]]
name = "cape"
sheet = {nx = 9, ny = 13, width_m = 0.4, height_m = 0.6}
position_m = [-0.12, 0, 0.9]
rotation_deg = [69.2820323, 69.2820323, 69.2820323]
density_kg_m2 = 0.2
stretch_n_m = 60
shear_n_m = 20
bend_n_m = 0.5
damping_ratio = 0.1
[[cloth.pin]]
edge = "top"
body = "torso"
[[body]]
name = "pelvis"
box = {size_m = [0.1, 0.1, 0.1]}
key = [{time_s = 0}, {time_s = 0.6, position_m = [0.5, 0, 0], rotation_deg = [0, 0, 80]}]
[[body]]
name = "torso"
parent = "pelvis"
box = {size_m = [0.2, 0.5, 0.8], cells = 3}
position_m = [0, 0, 0.9]
key = [{time_s = 0}, {time_s = 0.6, rotation_deg = [0, 30, 0]}]
)";

/// After `simulation` has gone to frame `end`: how far vertices of its pin were from where the body carries them, m.
double run_carried(Simulation& simulation, std::int64_t end) {
  const Collider& pin = simulation.world().colliders.back();
  const Precision precision = simulation.scene().collision.precision;
  double farthest_m = 0;
  testing::run_exactly_free(simulation, end, [&](const StepResult&) {
    const Positions carried = pin.placed_at(simulation.clock().time_s(), precision, simulation.x());
    farthest_m = std::max(farthest_m, (simulation.x()(pin.vertices(), Eigen::all) - carried).cwiseAbs().maxCoeff());
  });
  return farthest_m;
}

}  // namespace

TEST(Pin, IsCarriedByItsBody) {
  for (const std::string precision : {"float64", "float32"}) {
    std::string text = kCape;
    text.insert(text.find("friction_static"), "precision = \"" + precision + "\"\n");
    Simulation simulation(parse_scene(text, "cape.toml"));
    const World& world = simulation.world();
    const Positions x_t0 = simulation.x();
    EXPECT_EQ(world.deforms, (std::vector<std::uint8_t>{0, 0, 1})) << "of a pin each vertex waits by itself";
    ASSERT_EQ(run_carried(simulation, 20), 0);
    // The same rigid motion as that of the torso, found from its corners.
    const auto& pinned = world.colliders.back().vertices();
    const auto& torso = world.colliders[1].vertices();
    for (const VertexId corner : torso) {
      for (const VertexId v : pinned) {
        const double start_m = (x_t0.row(v) - x_t0.row(corner)).norm();
        const double end_m = (simulation.x().row(v) - simulation.x().row(corner)).norm();
        ASSERT_NEAR(start_m, end_m, precision == "float64" ? 1e-14 : 1e-6);
      }
    }
    EXPECT_GT((simulation.x().row(pinned[0]) - x_t0.row(pinned[0])).norm(), 0.2);
  }
}

// The lattice there is 6e-5 m, as wide as a fiftieth of the face that it hangs on, a third of a metre away.
TEST(Pin, FarFromTheOriginBeginsWhereItWasPut) {
  const Simulation simulation(parse_scene(R"(
[time]
frames = 1
[collision]
thickness_m = 0.01
precision = "float32"
[[cloth]]
sheet = {nx = 9, ny = 9, width_m = 1, height_m = 1}
position_m = [1000, 1000, 0.33]
density_kg_m2 = 0.2
stretch_n_m = 50
[[cloth.pin]]
edge = "top"
body = "ball"
[[body]]
name = "ball"
position_m = [1000, 1000, 0]
sphere = {radius_m = 0.05, subdivisions = 4}
)",
                                          "far.toml"));
  const std::vector<VertexId>& pinned = simulation.world().colliders.back().vertices();
  ASSERT_EQ(pinned.size(), 9U);
  for (std::size_t i = 0; i < 9; ++i) {
    const Eigen::RowVector3d put(999.5 + 0.125 * static_cast<double>(i), 1000.5, 0.33);
    EXPECT_LT((simulation.x().row(pinned[i]) - put).norm(), 1e-6) << i;
  }
}

TEST(Pin, OnABodyIsReleasedLikeAnyOther) {
  std::string text = kCape;
  text.insert(text.find("body = \"torso\""), "release_s = 0.2\n");
  Simulation simulation(parse_scene(text, "cape.toml"));
  ASSERT_EQ(run_carried(simulation, 6), 0);
  EXPECT_GT(run_carried(simulation, 18), 0.1) << "it falls";
}

TEST(Pin, WaitsWithItsBody) {
  // A ball is pressed too deep into cloth on the ground; a flag hangs on it.
  std::string text = R"(
squeeze = "yield"
gravity_m_s2 = [0, 0, -9.81]
[time]
frames = 30
[collision]
thickness_m = 0.004
friction_static = 0.3
[[cloth]]
sheet = {nx = 9, ny = 9, width_m = 0.5, height_m = 0.5}
position_m = [0, 0, 0.01]
density_kg_m2 = 0.2
stretch_n_m = 60
damping_ratio = 0.1
[[cloth]]
name = "flag"
sheet = {nx = 4, ny = 3, width_m = 0.15, height_m = 0.1}
position_m = [0.24, 0, 0.25]
density_kg_m2 = 0.2
stretch_n_m = 60
damping_ratio = 0.1
pin = [{edge = "left", body = "ball"}]
[[body]]
name = "ball"
sphere = {radius_m = 0.15, subdivisions = 2}
position_m = [0, 0, 0.25]
key = [{time_s = 0}, {time_s = 0.4, position_m = [0, 0, -0.12]}]
[[body]]
name = "ground"
sheet = {nx = 2, ny = 2, width_m = 20, height_m = 20}
)";
  Simulation simulation(parse_scene(text, "flag.toml"));
  EXPECT_EQ(run_carried(simulation, 30), 0);
  const Collider& ball = simulation.world().colliders.front();
  const Positions script = ball.placed_at(simulation.clock().time_s(), Precision::kFloat64, simulation.x());
  EXPECT_GT((simulation.x()(ball.vertices(), Eigen::all) - script).cwiseAbs().maxCoeff(), 0.01) << "it waits";
}

}  // namespace selvage::sim
