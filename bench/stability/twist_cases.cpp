#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "bench/stability/cases.h"
#include "bench/stability/hard_shapes.h"
#include "bench/stability/scene_play.h"
#include "bench/stability/stage.h"

namespace selvage::bench {
namespace {

using namespace fmt::literals;

/// A strip of 2 n by n vertices, each end turned by `turn_deg` against the other and moved in.
std::string twisted_strip_scene(int n, double turn_deg) {
  return fmt::format(R"(
drag_1_s = 1
squeeze = "yield"
[time]
frames_per_s = 30
frames = 120
max_step_s = 0.0166667
[collision]
thickness_m = 0.003
[[cloth]]
sheet = {{nx = {nx}, ny = {ny}, width_m = 1, height_m = 0.4}}
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
rotation_deg = [{turn}, 0, 0]
[[cloth.pin]]
edge = "right"
[[cloth.pin.key]]
time_s = 0
[[cloth.pin.key]]
time_s = 3
position_m = [-0.2, 0, 0]
rotation_deg = [-{turn}, 0, 0]
)",
                     "nx"_a = 2 * n, "ny"_a = n, "turn"_a = turn_deg);
}

constexpr double kFourTurnsDeg = 720;

/// Rows of vertices that lie at more than a right angle to the next are no twisted strip any more, and jam: 12 rows
/// stop at 3.3 turns, 108 degrees from row to row.
void twisted_strip(Trial& trial) {
  const int n = trial.pick(6, 10, 14);
  const double turn_deg = std::min(kFourTurnsDeg, 90.0 / 2 * (2 * n - 1));
  ScenePlay play(trial, twisted_strip_scene(n, turn_deg), 1);
  play.run_to(trial.variant().quick ? 0.1 : 3);
  trial.at_most("pins that waited", double(trial.report().waiting_bodies), 0);
}

/// Until its pins have waited so often: what is jammed stays so.
constexpr int kWaits = 50;

void overwound_strip(Trial& trial) {
  ScenePlay play(trial, twisted_strip_scene(trial.pick(6, 10, 14), 4 * kFourTurnsDeg), 1);
  const double end_s = trial.variant().quick ? 0.1 : 3;
  while (play.simulation().clock().time_s() < end_s && trial.report().waiting_bodies < kWaits) play.step();
  if (!trial.variant().quick) trial.at_least("pins that waited", double(trial.report().waiting_bodies), kWaits);
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
  if (!trial.variant().quick) trial.at_least("steps with contact", double(trial.report().steps_with_contact), 1);
}

}  // namespace

std::vector<StabilityCase> twist_cases() {
  return {
      {"twisted-strip", "a strip twisted by four turns, its ends moving in; by 90 degrees a row where that is less",
       "no pin waits", twisted_strip},
      {"overwound-strip", "a strip twisted by sixteen turns, more than any of its meshes holds",
       "its pins wait for it, and nothing passes through", overwound_strip},
      {"twisted-tube", "a tube twisted by three turns: its wall meets itself everywhere", "every step is taken",
       twisted_tube},
      {"knot", "a rope with a trefoil is pulled tight", "contact found, every step is taken", knot},
  };
}

}  // namespace selvage::bench
