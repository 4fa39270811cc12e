#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "bench/stability/cases.h"
#include "bench/stability/scene_play.h"
#include "bench/stability/stage.h"

namespace selvage::bench {
namespace {

const Vec3 kGravity(0, 0, -9.81);

void resting_contact(Trial& trial) {
  // A small sheet lies on the ground: the coarse one for 10^5 steps.
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
