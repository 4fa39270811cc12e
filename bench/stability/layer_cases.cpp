#include <algorithm>
#include <array>
#include <cmath>

#include "bench/stability/cases.h"
#include "bench/stability/hard_shapes.h"
#include "bench/stability/stage.h"

namespace selvage::bench {
namespace {

const Material kPaper{1e-3, 100, 1, 0.2};

/// Whether the middle vertices of the parts, all sheets of one odd size, still lie above each other in the order given.
bool keeps_order(const Stage& stage, const std::vector<Part>& upwards) {
  const auto height = [&](const Part& part) { return stage.x()(part.begin + part.size() / 2, 2); };
  for (std::size_t i = 0; i + 1 < upwards.size(); ++i) {
    if (!(height(upwards[i]) < height(upwards[i + 1]))) return false;
  }
  return true;
}

std::vector<Part> add_layers(StageSetup& setup, int count, int side, double gap_m, const Material& material) {
  std::vector<Part> layers;
  for (int i = 0; i < count; ++i) {
    layers.push_back(setup.add_cloth(sim::make_sheet(side, side, 1, 1), Vec3(0, 0, i * gap_m), material));
  }
  return layers;
}

void coplanar_sliding(Trial& trial) {
  const int side = trial.pick(3, 6, 12);
  for (const double speed : {1.0, 100.0}) {
    StageSetup setup;
    const sim::Shape sheet = sim::make_sheet(side, side, 1, 1);
    setup.add_cloth(sheet, Vec3(-0.51, 0, 0), kPaper, Vec3(speed, 0, 0));
    setup.add_cloth(sheet, Vec3(0.51, 0.25, 0), kPaper, Vec3(-speed, 0, 0));
    Stage stage(trial, setup);
    for (int step = 0; step < trial.steps(40, 6); ++step) stage.step();
    stage.require_balances();
    const double out_of_plane = (stage.x().col(2).array() - stage.offset().z()).abs().maxCoeff();
    trial.at_most("way out of the plane, m", out_of_plane, 1);
  }
  trial.at_least("steps with collisions", double(trial.report().steps_with_collisions), 1);
}

void coplanar_turning(Trial& trial) {
  const int side = trial.pick(2, 5, 10);
  StageSetup setup;
  const sim::Shape sheet = sim::make_sheet(side, side, 1, 1);
  const Part wheel = setup.add_cloth(sheet, Vec3::Zero());
  setup.add_cloth(sheet, Vec3(1.1, 0, 0));  // within reach of the corners
  Stage stage(trial, setup);
  for (int step = 0; step < trial.steps(12, 4); ++step) {
    Positions candidate = stage.x();
    const Vec3 centre = stage.centre(wheel) + stage.offset();
    const Positions arms = candidate.middleRows(wheel.begin, wheel.size()).rowwise() - centre.transpose();
    candidate.middleRows(wheel.begin, wheel.size()) = sim::place({centre, Vec3(0, 0, 30)}, arms);
    stage.step_to(candidate);
  }
  trial.at_least("steps with collisions", double(trial.report().steps_with_collisions), 1);
}

void same_velocity(Trial& trial) {
  StageSetup setup;
  setup.collision.repulsion = false;
  add_layers(setup, 4, trial.pick(3, 8, 20), 2 * setup.collision.tolerance_m, {});
  setup.v.rowwise() += Eigen::RowVector3d(10, -7, 300);
  Stage stage(trial, setup);
  for (int step = 0; step < trial.steps(10, 3); ++step) {
    const Positions candidate = stage.candidate();
    stage.step_to(candidate);
    trial.require(stage.x() == candidate, "the candidates were changed");
  }
}

void rigid_turn(Trial& trial) {
  StageSetup setup;
  setup.collision.repulsion = false;
  add_layers(setup, 3, trial.pick(3, 6, 12), 1.5 * setup.collision.tolerance_m, {});
  Stage stage(trial, setup);
  for (const double angle_deg : {1.0, 10.0, 30.0, 90.0, 120.0, 150.0, 179.0}) {
    for (const Vec3& axis : {Vec3(1, 0, 0), Vec3(0, 0, 1), Vec3(0.6, 0, 0.8)}) {
      const Vec3 centre = stage.x().colwise().mean();
      const Positions arms = stage.x().rowwise() - centre.transpose();
      const Positions candidate = sim::place({centre, axis * angle_deg}, arms);
      stage.step_to(candidate);
      trial.require(stage.x() == candidate, "the candidates were changed");
    }
  }
}

void layers_at_speed(Trial& trial) {
  constexpr double kGap = 2e-3;
  const int side = trial.pick(3, 5, 7);
  for (const double speed : {10.0, 1'000.0}) {  // fifty gaps a step, and five thousand
    StageSetup setup;
    add_layers(setup, 8, side, kGap, {});
    const Part shot =
        setup.add_cloth(sim::make_sheet(side, side, 0.8, 0.8), Vec3(0.03, 0.02, 9 * kGap), {}, Vec3(0, 0, -speed));
    Stage stage(trial, setup);
    for (int step = 0; step < trial.steps(8, 2); ++step) stage.step();
    stage.require_balances();
    trial.at_most("speed left to the shot", stage.mean_velocity(shot).norm() / speed, 0.9);
  }
}

/// A sheet slides over another that it presses on: friction may only slow it down.
void rubbing_layers(Trial& trial) {
  const int side = trial.pick(3, 6, 12);
  StageSetup setup;
  setup.collision.friction_static = setup.collision.friction_kinetic = 0.4;
  const sim::Shape sheet = sim::make_sheet(side, side, 1, 1);
  setup.add_cloth(sheet, Vec3::Zero());
  const Part upper =
      setup.add_cloth(sheet, Vec3(0.03, 0.02, 0.9 * setup.collision.thickness_m), kPaper, Vec3(1, 0.2, -0.5));
  Stage stage(trial, setup);
  const double start = stage.mean_velocity(upper).head<2>().norm();
  for (int step = 0; step < trial.steps(20, 4); ++step) stage.step();
  stage.require_balances();
  trial.at_most("speed left along the sheets", stage.mean_velocity(upper).head<2>().norm() / start, 0.95);
}

void layer_reversal(Trial& trial) {
  StageSetup setup;
  const std::vector<Part> layers = add_layers(setup, 6, trial.pick(3, 5, 7), 2e-3, {});
  Stage stage(trial, setup);
  for (int step = 0; step < trial.steps(6, 2); ++step) {
    Positions candidate = stage.x();
    const double middle = candidate.col(2).mean();
    candidate.col(2) = 2 * middle - candidate.col(2).array();
    stage.step_to(candidate);
    trial.require(keeps_order(stage, layers), "layers changed places");
  }
  stage.require_balances();
}

void card_stack(Trial& trial) {
  StageSetup setup;
  setup.gravity_m_s2 = Vec3(0, 0, -9.81);
  setup.dt_s = 2e-3;
  setup.collision.friction_static = setup.collision.friction_kinetic = 0.3;
  setup.add_body(sim::make_sheet(2, 2, 3, 3), Vec3(0, 0, -1.5e-3));
  const std::vector<Part> cards = add_layers(setup, trial.pick(10, 20, 40), 3, 1.5e-3, kPaper);
  Stage stage(trial, setup);
  for (int step = 0; step < trial.steps(250, 10); ++step) stage.step();
  trial.require(keeps_order(stage, cards), "cards changed places");
  double sideways = 0;
  for (const Part& card : cards) sideways = std::max(sideways, stage.centre(card).head(2).norm());
  trial.at_most("way of a card sideways, m", sideways, 1e-3);
}

void card_shuffle(Trial& trial) {
  StageSetup setup;
  setup.gravity_m_s2 = Vec3(0, 0, -9.81);
  setup.dt_s = 2e-3;
  setup.collision.friction_static = setup.collision.friction_kinetic = 0.2;
  setup.add_body(sim::make_sheet(2, 2, 6, 6), Vec3(0, 0, -1.5e-3));
  std::array<std::vector<Part>, 2>
      halves;  // left, right: only within one do cards lie with all of their area on each other
  const sim::Shape card = sim::make_sheet(3, 3, 1, 1);
  for (int i = 0; i < trial.pick(8, 16, 24); ++i) {
    const double side = i % 2 == 0 ? -1 : 1;  // overlapping by a fifth, driven into each other
    halves[static_cast<std::size_t>(i % 2)].push_back(
        setup.add_cloth(card, Vec3(0.4 * side, 0, i * 1.5e-3), kPaper, Vec3(-2 * side, 0, 0)));
  }
  Stage stage(trial, setup);
  for (int step = 0; step < trial.steps(200, 10); ++step) stage.step();
  for (const std::vector<Part>& cards : halves) trial.require(keeps_order(stage, cards), "cards changed places");
}

}  // namespace

std::vector<StabilityCase> layer_cases() {
  return {
      {"coplanar-sliding", "two sheets in one plane: every cubic is zero, no normal exists",
       "contact found; momentum and energy kept", coplanar_sliding},
      {"coplanar-turning", "a square turns 30 degrees a step into another in its plane", "contact found",
       coplanar_turning},
      {"same-velocity", "layers two tolerances apart fly together, 3 m a step", "no candidate is changed by a bit",
       same_velocity},
      {"rigid-turn", "layers 1.5 tolerances apart turn as one, up to 179 degrees a step: chords come close",
       "no candidate is changed by a bit", rigid_turn},
      {"layers-at-speed", "a sheet is shot through eight others in one step",
       "the shot loses speed to them; momentum and energy kept", layers_at_speed},
      {"rubbing-layers", "a sheet slides over one that it presses on", "friction slows it; momentum and energy kept",
       rubbing_layers},
      {"layer-reversal", "six layers are asked to swap places", "they keep their order; momentum and energy kept",
       layer_reversal},
      {"card-stack", "10 to 40 cards rest on each other", "cards keep their order and their place", card_stack},
      {"card-shuffle", "two half stacks are pushed into each other", "the cards of each half keep their order",
       card_shuffle},
  };
}

}  // namespace selvage::bench
