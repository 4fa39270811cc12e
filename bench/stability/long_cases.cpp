#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "bench/stability/cases.h"
#include "bench/stability/hard_shapes.h"
#include "bench/stability/scene_play.h"
#include "bench/stability/stage.h"

namespace selvage::bench {
namespace {

const Vec3 kGravity(0, 0, -9.81);

void resting_contact(Trial& trial) {
  // A small sheet lies on the ground for 10^5 steps.
  StageSetup setup;
  setup.gravity_m_s2 = kGravity;
  setup.dt_s = 1e-3;
  setup.add_body(sim::make_sheet(2, 2, 4, 4), Vec3::Zero());
  const int side = trial.pick(2, 3, 4);
  const Part sheet =
      setup.add_cloth(sim::make_sheet(side, side, 0.1, 0.1), Vec3(0.03, 0.02, 1.2e-3), {1e-3, 20, 0, 0.3});
  Stage stage(trial, setup);
  const Vec3 start = stage.centre(sheet);
  const double energy_start = stage.energy_j();
  double most_energy = energy_start;
  for (int step = 0; step < trial.steps(100'000, 200); ++step) {
    stage.step();
    most_energy = std::max(most_energy, stage.energy_j());
  }
  const double height_j =
      static_cast<double>(sheet.size()) * 1e-3 * 9.81 * 1e-3;  // of all vertices lifted by a thickness
  trial.at_most("energy gained / energy of a thickness", (most_energy - energy_start) / height_j, 1e-6);
  trial.at_most("drift sideways, m", (stage.centre(sheet) - start).head(2).norm(), 1e-9);
  trial.at_most("fail-safe steps", double(trial.report().fail_safe_steps), 0);
}

void internal_edges(Trial& trial) {
  // Cloth slides over a flat ground of many faces, without friction: their edges must not be felt.
  StageSetup setup;
  setup.dt_s = 2e-3;
  setup.add_body(sim::make_sheet(trial.pick(10, 20, 40), trial.pick(10, 20, 40), 4, 4), Vec3::Zero());
  const Part sheet = setup.add_cloth(sim::make_sheet(5, 5, 0.4, 0.4), Vec3(-1.013, -0.507, 0.6e-3), {1e-3, 100, 0, 0.2},
                                     Vec3(2, 1, 0));
  Stage stage(trial, setup);
  for (int step = 0; step < trial.steps(400, 20); ++step) stage.step();
  trial.at_least("steps near the ground", double(trial.report().steps), 1);
  const Vec3 change = stage.mean_velocity(sheet) - Vec3(2, 1, 0);
  trial.at_most("change of velocity along the ground, m/s", change.head(2).norm(), 1e-9);
  trial.at_most("velocity off the ground, m/s", std::abs(change.z()), 1e-9);
}

void cliff_edge(Trial& trial) {
  const int n = trial.pick(8, 12, 18);
  ScenePlay play(trial,
                 fmt::format(R"(
gravity_m_s2 = [0, 0, -9.81]
drag_1_s = 4
[time]
frames_per_s = 30
frames = 200
max_step_s = 0.0166667
[collision]
thickness_m = 0.004
friction_static = 0.6
[[cloth]]
sheet = {{nx = {}, ny = {}, width_m = 0.6, height_m = 0.6}}
position_m = [0.12, 0, 0.005]
density_kg_m2 = 0.2
stretch_n_m = 40
shear_n_m = 12
bend_n_m = 0.4
damping_ratio = 0.4
[[body]]
box = {{size_m = [1, 1, 0.4], cells = 4}}
position_m = [-0.3, 0, -0.2]
)",
                             n, n),
                 1);
  play.run_to(trial.variant().quick ? 0.2 : 4);
  if (trial.variant().quick) return;
  const Positions at_rest = play.x();
  play.run_to(5);
  trial.at_most("drift in a second, m", (play.x() - at_rest).rowwise().norm().maxCoeff(), 2e-3);
}

void twisted_strip(Trial& trial) {
  const int n = trial.pick(6, 10, 14);
  ScenePlay play(trial,
                 fmt::format(R"(
drag_1_s = 1
squeeze = "yield"
[time]
frames_per_s = 30
frames = 120
max_step_s = 0.0166667
[collision]
thickness_m = 0.003
[[cloth]]
sheet = {{nx = {}, ny = {}, width_m = 1, height_m = 0.4}}
density_kg_m2 = 0.2
stretch_n_m = 60
shear_n_m = 20
bend_n_m = 0.2
damping_ratio = 0.3
[[cloth.pin]]
edge = "left"
[[cloth.pin.key]]
time_s = 0
[[cloth.pin.key]]
time_s = 3
position_m = [0.2, 0, 0]
rotation_deg = [720, 0, 0]
[[cloth.pin]]
edge = "right"
[[cloth.pin.key]]
time_s = 0
[[cloth.pin.key]]
time_s = 3
position_m = [-0.2, 0, 0]
rotation_deg = [-720, 0, 0]
)",
                             2 * n, n),
                 1);
  play.run_to(trial.variant().quick ? 0.1 : 3);
  trial.at_most("pins that waited", double(trial.report().waiting_bodies), 0);
}

/// A tube about the x axis, open at both ends; vertex (ring, i) is number ring * facets + i.
sim::Shape make_tube(int rings, int facets, double length_m, double radius_m) {
  sim::Shape tube;
  tube.x.resize(Eigen::Index{rings} * facets, 3);
  for (int ring = 0; ring < rings; ++ring) {
    for (int i = 0; i < facets; ++i) {
      const double angle = 2 * std::numbers::pi * (i + 0.5 * (ring % 2)) / facets;
      tube.x.row(ring * facets + i) << (double(ring) / (rings - 1) - 0.5) * length_m, radius_m * std::cos(angle),
          radius_m * std::sin(angle);
      if (ring + 1 == rings) continue;
      const int next = (i + 1) % facets, a = ring * facets + i, b = ring * facets + next;
      const int c = a + facets, d = b + facets;
      if (ring % 2 == 0) {
        tube.triangles.push_back({a, b, c});
        tube.triangles.push_back({b, d, c});
      } else {
        tube.triangles.push_back({a, b, d});
        tube.triangles.push_back({a, d, c});
      }
    }
  }
  return tube;
}

std::vector<VertexId> ring_of(int facets, int ring) {
  std::vector<VertexId> vertices;
  for (int i = 0; i < facets; ++i) vertices.push_back(ring * facets + i);
  return vertices;
}

void twisted_tube(Trial& trial) {
  const int facets = trial.pick(6, 9, 12), rings = 2 * facets;
  StageSetup setup;
  setup.dt_s = 5e-3;
  setup.drag_1_s = 2;
  setup.collision.thickness_m = 3e-3;
  setup.policy = sim::SqueezePolicy::kYield;
  setup.add_cloth(make_tube(rings, facets, 1, 0.15), Vec3::Zero(), {1e-3, 100, 0.2, 0.3});
  setup.pin(ring_of(facets, 0), {{0, {}}, {2, {Vec3(0.15, 0, 0), Vec3(540, 0, 0)}}});
  setup.pin(ring_of(facets, rings - 1), {{0, {}}, {2, {Vec3(-0.15, 0, 0), Vec3(-540, 0, 0)}}});
  Stage stage(trial, setup);
  for (int step = 0; step < trial.steps(400, 8); ++step) stage.step();
  trial.at_least("steps", double(trial.report().steps), trial.steps(400, 8));
}

/// A rope of `segments` along (t^3 - 3 t, t^4 - 4 t^2, t^5 / 5 - 2 t), a trefoil with loose ends.
sim::Shape make_knot(int segments, int facets, double radius) {
  constexpr double kEnd = 2.15;
  const auto at = [](double t) {
    return Vec3(t * t * t - 3 * t, 0.5 * (t * t * t * t - 4 * t * t), 0.2 * std::pow(t, 5) - 2 * t);
  };
  sim::Shape rope;
  rope.x.resize(Eigen::Index{segments} * facets, 3);
  Vec3 side(0, 0, 1);
  for (int ring = 0; ring < segments; ++ring) {
    const double t = kEnd * (2.0 * ring / (segments - 1) - 1);
    const Vec3 along = (at(t + 1e-4) - at(t - 1e-4)).normalized();
    side = (side - along * along.dot(side)).normalized();  // carried along without turning about the rope
    const Vec3 other = along.cross(side);
    for (int i = 0; i < facets; ++i) {
      const double angle = 2 * std::numbers::pi * i / facets;
      rope.x.row(ring * facets + i) = (at(t) + radius * (std::cos(angle) * side + std::sin(angle) * other)).transpose();
      if (ring + 1 == segments) continue;
      const int a = ring * facets + i, b = ring * facets + (i + 1) % facets;
      rope.triangles.push_back({a, b, a + facets});
      rope.triangles.push_back({b, b + facets, a + facets});
    }
  }
  return rope;
}

void knot(Trial& trial) {
  const int segments = trial.pick(40, 70, 110), facets = trial.pick(3, 4, 5);
  StageSetup setup;
  setup.dt_s = 5e-3;
  setup.drag_1_s = 2;
  setup.collision.thickness_m = 0.02;
  setup.collision.friction_static = setup.collision.friction_kinetic = 0.3;
  setup.policy = sim::SqueezePolicy::kYield;
  setup.add_cloth(make_knot(segments, facets, 0.15), Vec3::Zero(), {1e-3, 200, 1, 0.3});
  const Vec3 pull = Vec3(setup.x.row(0) - setup.x.row(setup.x.rows() - 1)).normalized() * 3;
  setup.pin(ring_of(facets, 0), {{0, {}}, {1.5, {pull}}});
  setup.pin(ring_of(facets, segments - 1), {{0, {}}, {1.5, {-pull}}});
  Stage stage(trial, setup);
  for (int step = 0; step < trial.steps(300, 6); ++step) stage.step();
  if (!trial.variant().quick) {
    trial.at_least("steps with collisions", double(trial.report().steps_with_collisions), 1);
  }
}

/// An open cone about the z axis from `top` radius at z = 0 down to `bottom` at z = -height.
sim::Shape make_funnel(int facets, double top_m, double bottom_m, double height_m) {
  sim::Shape funnel = make_tube(2, facets, 1, 1);
  for (Eigen::Index i = 0; i < funnel.x.rows(); ++i) {
    const double radius = i < facets ? top_m : bottom_m;
    funnel.x.row(i) = Eigen::RowVector3d(radius * funnel.x(i, 1), radius * funnel.x(i, 2), i < facets ? 0 : -height_m);
  }
  return funnel;
}

void funnel(Trial& trial) {
  // A sheet is pulled by its middle through a hole of a sixth of its width.
  const int side = trial.pick(7, 11, 15);
  StageSetup setup;
  setup.dt_s = 4e-3;
  setup.gravity_m_s2 = kGravity;
  setup.drag_1_s = 1;
  setup.collision.thickness_m = 3e-3;
  setup.policy = sim::SqueezePolicy::kYield;
  const Part sheet = setup.add_cloth(sim::make_sheet(side, side, 0.6, 0.6), Vec3(0, 0, 0.02), {1e-3, 150, 0.2, 0.3});
  setup.pin({side * side / 2}, {{0, {}}, {1.2, {Vec3(0, 0, -1.2)}}});
  setup.add_body(make_funnel(trial.pick(12, 18, 24), 0.6, 0.1, 0.35), Vec3::Zero());
  Stage stage(trial, setup);
  const int steps = trial.steps(300, 10);
  for (int step = 0; step < steps; ++step) stage.step();
  trial.at_most("height of the sheet, m", stage.centre(sheet).z(), trial.variant().quick ? 0.1 : -0.1);
}

// Of scenes in which cloth rubs on cloth, and is squeezed.
constexpr const char* kRubbing = R"(gravity_m_s2 = [0, 0, -9.81]
drag_1_s = 0.5
squeeze = "yield"
[time]
frames_per_s = 30
frames = 60
max_step_s = 0.0166667
[collision]
thickness_m = 0.004
friction_static = 0.3
)";
constexpr const char* kLinen = R"(density_kg_m2 = 0.3
stretch_n_m = 80
shear_n_m = 20
bend_n_m = 0.2
damping_ratio = 0.3
)";

void tablecloth_pull(Trial& trial) {
  // A cloth is pulled from under another, over the edge of a table.
  const int n = trial.pick(8, 12, 18);
  ScenePlay play(trial,
                 fmt::format(R"(
{}[[cloth]]
name = "tablecloth"
sheet = {{nx = {}, ny = {}, width_m = 1, height_m = 0.8}}
position_m = [0, 0, 0.005]
{}[[cloth.pin]]
edge = "right"
[[cloth.pin.key]]
time_s = 0
[[cloth.pin.key]]
time_s = 0.3
[[cloth.pin.key]]
time_s = 1
position_m = [1.4, 0, 0]
[[cloth]]
name = "napkin"
sheet = {{nx = {}, ny = {}, width_m = 0.4, height_m = 0.4}}
position_m = [0, 0, 0.011]
rotation_deg = [0, 0, 20]
{}[[body]]
box = {{size_m = [0.96, 0.76, 0.2], cells = 3}}
position_m = [0, 0, -0.1]
)",
                             kRubbing, n, n, kLinen, n / 2, n / 2, kLinen),
                 1);
  play.run_to(trial.variant().quick ? 0.05 : 1.4);
  trial.at_most("largest strain", play.largest_strain(), 0.5);
}

void ball_through_stack(Trial& trial) {
  // A ball presses a stack of cloths onto the ground, until it must wait.
  const int n = trial.pick(6, 9, 13);
  std::string cloths;
  for (int i = 0; i < 4; ++i) {
    cloths += fmt::format(R"([[cloth]]
name = "cloth {}"
sheet = {{nx = {}, ny = {}, width_m = 0.6, height_m = 0.6}}
position_m = [0, 0, {}]
density_kg_m2 = 0.2
stretch_n_m = 60
shear_n_m = 20
bend_n_m = 0.2
damping_ratio = 0.3
)",
                          i, n, n, 0.005 + 0.006 * i);
  }
  ScenePlay play(trial,
                 fmt::format(R"(
{}{}
[[body]]
sphere = {{radius_m = 0.15, subdivisions = 2}}
[[body.key]]
time_s = 0
position_m = [0, 0, 0.25]
[[body.key]]
time_s = 1
position_m = [0, 0, 0.05]
[[body]]
name = "ground"
sheet = {{nx = 2, ny = 2, width_m = 4, height_m = 4}}
)",
                             kRubbing, cloths),
                 1);
  play.run_to(trial.variant().quick ? 0.05 : 0.8);
  trial.at_least(trial.variant().quick ? "steps" : "times the ball waited",
                 double(trial.variant().quick ? trial.report().steps : trial.report().waiting_bodies), 1);
}

}  // namespace

std::vector<StabilityCase> long_cases() {
  return {
      {"resting-contact", "a sheet lies on the ground for 100,000 steps", "no energy gained, no drift, no fail-safe",
       resting_contact},
      {"internal-edges", "a sheet slides over the inner edges of a flat ground", "it does not feel them",
       internal_edges},
      {"cliff-edge", "cloth hangs over the edge of a box", "it comes to rest", cliff_edge},
      {"twisted-strip", "a strip twisted by four turns, its ends moving in", "no pin waits", twisted_strip},
      {"twisted-tube", "a tube twisted by three turns: its wall meets itself everywhere", "every step is taken",
       twisted_tube},
      {"knot", "a rope with a trefoil is pulled tight", "contact found, every step is taken", knot},
      {"funnel", "a sheet is pulled through a hole of a third of its width", "it goes down", funnel},
      {"tablecloth-pull", "a cloth is pulled from under another, over an edge", "strain at most 0.5", tablecloth_pull},
      {"ball-on-stack", "a ball presses four cloths onto the ground", "it waits", ball_through_stack},
  };
}

}  // namespace selvage::bench
