#include "bench/sim_bench.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "bench/sim_scenes.h"

namespace selvage::bench {
namespace {

TEST(SimRun, ASwingWithoutDampingKeepsItsEnergyAndFinerStepsKeepItBetter) {
  const SimRun coarse = run_simulation(swing_scene(sim::Solver::kExplicit, 9, 32)),
               fine = run_simulation(swing_scene(sim::Solver::kExplicit, 9, 64));
  EXPECT_EQ(coarse.frames, 8);
  EXPECT_EQ(coarse.contacts, 0);
  EXPECT_GT(coarse.energy_drift, 0);
  EXPECT_LT(coarse.energy_drift, 1e-3);
  EXPECT_LT(fine.energy_drift, coarse.energy_drift / 3);  // second order
}

// The bound of implicit steps to 1/192 s made runs of 1, 2, 4 and 8 steps a frame of 1/30 s the same run.
TEST(SimRun, ASwingTakesAsFewImplicitStepsAsAsked) {
  const SimRun one = run_simulation(swing_scene(sim::Solver::kImplicit, 9, 1)),
               two = run_simulation(swing_scene(sim::Solver::kImplicit, 9, 2));
  EXPECT_EQ(one.steps, one.frames);
  EXPECT_GT(one.energy_drift, 2 * two.energy_drift);
}

// Undamped sheets in contact, the collision step four internal steps long: where the average velocity of a step took
// the place of the cloth's own, this gained 1.68 of the kinetic energy, and angular momentum drifted by 5e-4.
TEST(SimRun, ContactPutsNoEnergyIn) {
  sim::Scene scene = meeting_scene(sim::Solver::kExplicit);
  scene.time.max_step_s = 0.0042;
  const SimRun run = run_simulation(scene);
  EXPECT_GT(run.contacts, 1000);
  EXPECT_LT(run.energy_gain, 0.01);
  EXPECT_LT(run.momentum_drift, 1e-12);
  EXPECT_LT(run.angular_momentum_drift, 1e-4);
}

TEST(SimRun, StopsAfterAsManyStepsAsAsked) {
  EXPECT_EQ(run_simulation(drape_scene(sim::Solver::kExplicit, 12), {.most_steps = 2}).steps, 2);
}

// Four times the faces of the sheet alone are 2 (n - 1) + 1 vertices along each side.
TEST(SimRun, SubdividesEveryFrameWhereAskedTo) {
  const std::vector<ModuleScene> scenes = module_scenes(12);
  EXPECT_EQ(scenes.front().subdivision_levels, 0);
  const SimRun run = run_simulation(scenes.front().scene, {.subdivision_levels = scenes.back().subdivision_levels});
  EXPECT_EQ(run.fine_vertices, 23 * 23);
}

TEST(SimBench, SheetDistanceIsBetweenTheSamePlaces) {
  Positions coarse = Positions::Zero(4, 3), fine = Positions::Zero(25, 3);
  for (int j = 0; j < 5; ++j) {
    for (int i = 0; i < 5; ++i) fine.row(j * 5 + i) << i, j, 0;
  }
  coarse << 0, 0, 0, 4, 0, 0, 0, 4, 0, 4, 4, 2;  // one corner is 2 away
  EXPECT_EQ(sheet_distance(coarse, 2, fine, 5), 1);
}

TEST(SimBench, JsonCarriesItsSchema) {
  SimBenchReport report;
  report.growth.push_back({sim::Solver::kImplicit, 10, 1, {}});
  const auto json = nlohmann::json::parse(to_json(report));
  EXPECT_EQ(json.at("schema"), "selvage.bench.sim/1");
  EXPECT_EQ(json.at("growth").at(0).at("solver"), "implicit");
  EXPECT_EQ(json.at("growth").at(0).at("nodes"), 10);
}

}  // namespace
}  // namespace selvage::bench
