#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "bench/stability/cases.h"
#include "bench/stability/scene_play.h"
#include "bench/stability/stage.h"

namespace selvage::bench {
namespace {

void resting_contact(Trial& trial) {
  // A small sheet lies on the ground: the coarse one for 10^5 steps.
  StageSetup setup;
  setup.gravity_m_s2 = {0, 0, -9.81};
  setup.dt_s = 1e-3;
  setup.add_body(sim::make_sheet(2, 2, 4, 4), Vec3::Zero());
  const int side = trial.pick(2, 3, 4);
  const Part sheet =
      setup.add_cloth(sim::make_sheet(side, side, 0.1, 0.1), Vec3(0.03, 0.02, 1.2e-3), {1e-3, 20, 0, 0.3});
  Stage stage(trial, setup);
  const Vec3 start = stage.centre(sheet);
  const double energy_start = stage.energy_j();
  double most_energy = energy_start;
  for (int step = 0; step < trial.steps(trial.pick(100'000, 10'000, 10'000), 200); ++step) {
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
  // Cloth lies on a flat ground of many faces and slides over them, without friction: their edges must not be felt.
  const int n = trial.pick(10, 20, 40);
  ScenePlay play(trial,
                 scene_start(0, 0) + fmt::format(R"(
[[cloth]]
sheet = {{nx = 9, ny = 9, width_m = 0.4, height_m = 0.4}}
position_m = [-1.013, -0.507, 0.004]
velocity_m_s = [2, 1, 0]
density_kg_m2 = 0.2
stretch_n_m = 40
shear_n_m = 12
damping_ratio = 0.4
[[body]]
sheet = {{nx = {}, ny = {}, width_m = 4, height_m = 4}}
)",
                                                 n, n),
                 1);
  play.run_to(trial.variant().quick ? 0.1 : 0.8);
  trial.at_least("share of steps on the ground",
                 double(trial.report().steps_with_contact) / double(trial.report().steps), 0.9);
  const Eigen::Index cloth = play.simulation().world().cloth_vertex_count;
  const Vec3 v = play.simulation().state().v.topRows(cloth).colwise().mean();
  // 3e-8 m/s. With contacts that stay with the face that their vertex has left: 0.009 and more.
  trial.at_most("change of velocity along the ground, m/s", (v - Vec3(2, 1, 0)).head(2).norm(), 1e-6);
  const double height_m = play.x().topRows(cloth).col(2).mean() - play.offset().z();
  trial.at_most("way off the height of a thickness, m", std::abs(height_m - 0.004), 1e-4);
}

void cliff_edge(Trial& trial) {
  const int n = trial.pick(8, 12, 18);
  ScenePlay play(trial,
                 scene_start(4, 0.6) + fmt::format(R"(
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

}  // namespace

std::vector<StabilityCase> rest_cases() {
  return {
      {"resting-contact", "a sheet lies on the ground for 100,000 steps, finer ones for 10,000",
       "no energy gained, no drift, no fail-safe", resting_contact},
      {"internal-edges", "a sheet slides over the inner edges of a flat ground", "it does not feel them",
       internal_edges},
      {"cliff-edge", "cloth hangs over the edge of a box", "it comes to rest", cliff_edge},
  };
}

}  // namespace selvage::bench
