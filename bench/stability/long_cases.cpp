#include <algorithm>

#include <fmt/format.h>

#include "bench/stability/cases.h"
#include "bench/stability/hard_shapes.h"
#include "bench/stability/scene_play.h"
#include "bench/stability/stage.h"

namespace selvage::bench {
namespace {

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
  setup.gravity_m_s2 = {0, 0, -9.81};
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
std::string rubbing_start() { return scene_start(0.5, 0.3, "squeeze = \"yield\"\n"); }
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
                             rubbing_start(), n, n, kLinen, n / 2, n / 2, kLinen),
                 1);
  double most = 0;
  for (int frame = 1; frame <= (trial.variant().quick ? 2 : 42); ++frame) {
    play.run_to(frame / 30.0);
    most = std::max(most, play.largest_strain());
  }
  trial.at_most("largest strain on the way", most, 0.5);
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
                             rubbing_start(), cloths),
                 1);
  play.run_to(trial.variant().quick ? 0.05 : 0.8);
  trial.at_least(trial.variant().quick ? "steps" : "times the ball waited",
                 double(trial.variant().quick ? trial.report().steps : trial.report().waiting_bodies), 1);
}

}  // namespace

std::vector<StabilityCase> long_cases() {
  return {
      {"funnel", "a sheet is pulled through a hole of a third of its width", "it goes down", funnel},
      {"tablecloth-pull", "a cloth is pulled from under another, over an edge", "strain at most 0.5 on the way",
       tablecloth_pull},
      {"ball-on-stack", "a ball presses four cloths onto the ground", "it waits", ball_through_stack},
  };
}

}  // namespace selvage::bench
