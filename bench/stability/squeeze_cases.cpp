#include <algorithm>

#include "bench/stability/cases.h"
#include "bench/stability/hard_shapes.h"
#include "bench/stability/stage.h"

namespace selvage::bench {
namespace {

const Material kSqueezedCloth{1e-3, 100, 0, 0.2};

/// A sheet between two boxes that close at 1 m/s from either side; or against the lower one, which rests.
StageSetup press(Trial& trial, bool lower_rests) {
  StageSetup setup;
  const sim::Shape box = sim::make_box(Vec3(0.8, 0.8, 0.2), trial.pick(1, 2, 4));
  setup.add_cloth(sim::make_sheet(trial.pick(4, 8, 16), trial.pick(4, 8, 16), 1, 1), Vec3::Zero(), kSqueezedCloth);
  setup.add_body(box, {{0, {Vec3(0, 0, 0.12)}}, {1, {Vec3(0, 0, -0.88)}}});
  const Vec3 start(0.05, 0.03, -0.12);
  if (lower_rests) {
    setup.add_body(box, start);
  } else {
    setup.add_body(box, {{0, {start}}, {1, {start + Vec3(0, 0, 1)}}});
  }
  return setup;
}

void pinched_stop(Trial& trial) {
  StageSetup setup = press(trial, false);
  setup.policy = sim::SqueezePolicy::kStop;
  Stage stage(trial, setup);
  for (int step = 0; step < 20; ++step) {
    const Positions before = stage.x();
    const sim::CollisionStepReport& report = stage.try_step_to(stage.candidate());
    if (report.status == sim::StepStatus::kSafe) continue;
    trial.require(report.status == sim::StepStatus::kStopped && report.witness, "it ended without a witness");
    trial.require(stage.x() == before, "the state moved");
    trial.at_least("steps before the stop", step, 1);
    return;
  }
  trial.require(false, "the bodies went through each other");
}

/// Runs on while bodies wait; the step in which the first one did.
void yield(Trial& trial, StageSetup setup, int steps) {
  setup.policy = sim::SqueezePolicy::kYield;
  Stage stage(trial, std::move(setup));
  for (int step = 0; step < steps; ++step) stage.step();
  trial.at_least("times a body waited", double(trial.report().waiting_bodies), 1);
}

void pinched_yield(Trial& trial) { yield(trial, press(trial, false), trial.steps(25, 14)); }
void pressed_on_rest(Trial& trial) { yield(trial, press(trial, true), trial.steps(40, 14)); }

void pinched_three(Trial& trial) {
  StageSetup setup = press(trial, false);
  const sim::Shape box = sim::make_box(Vec3(0.1, 0.8, 0.8), trial.pick(1, 2, 4));
  setup.add_body(box, {{0, {Vec3(0.6, 0, 0)}}, {1, {Vec3(-0.9, 0, 0)}}});
  yield(trial, std::move(setup), trial.steps(30, 14));
}

void spike_press(Trial& trial) {
  StageSetup setup;
  setup.add_cloth(sim::make_sheet(trial.pick(5, 9, 17), trial.pick(5, 9, 17), 1, 1), Vec3::Zero(), kSqueezedCloth);
  setup.add_body(sim::make_sheet(2, 2, 3, 3), Vec3(0, 0, -0.05));
  // Exactly above the middle vertex.
  setup.add_body(make_spike(trial.pick(3, 8, 16), 0.2, 0.4), {{0, {Vec3(0, 0, 0.05)}}, {1, {Vec3(0, 0, -1.95)}}});
  yield(trial, std::move(setup), trial.steps(30, 14));
}

void rollers(Trial& trial) {
  // Nothing but their friction moves the strip: each side presses on it where it is nearer than the thickness, 1 mm.
  StageSetup setup;
  setup.collision.friction_static = setup.collision.friction_kinetic = 0.6;
  setup.collision.repulsion_stiffness_n_m = 200;
  setup.dt_s = 4e-3;
  const int side = trial.pick(5, 9, 15);
  const Part strip = setup.add_cloth(turned(sim::make_sheet(side, side, 0.3, 0.6), Vec3(90, 0, 0)), Vec3(0, 0, 0.25),
                                     {1e-3, 200, 0.1, 0.3});
  const sim::Shape roller = sim::make_sphere(0.3, trial.pick(1, 2, 3));
  const double apart = 0.3 + 0.4e-3;
  setup.add_body(roller, {{0, {Vec3(0, apart, 0), Vec3(0, 0, 0)}}, {2, {Vec3(0, apart, 0), Vec3(720, 0, 0)}}});
  setup.add_body(roller, {{0, {Vec3(0, -apart, 0), Vec3(0, 0, 0)}}, {2, {Vec3(0, -apart, 0), Vec3(-720, 0, 0)}}});
  setup.policy = sim::SqueezePolicy::kYield;
  Stage stage(trial, setup);
  const double before = stage.centre(strip).z();
  for (int step = 0; step < trial.steps(150, 50); ++step) stage.step();
  // 0.17 m and more, 0.007 in the short form. Without friction the faces that come by push it up to 0.114 m, and 3e-7.
  trial.at_least("way of the strip downwards, m", before - stage.centre(strip).z(),
                 trial.variant().quick ? 1e-3 : 0.15);
}

void pins_cross(Trial& trial) {
  // The two ends of a sheet are asked to change places, through its middle.
  StageSetup setup;
  const int side = trial.pick(3, 4, 6);
  setup.add_cloth(sim::make_sheet(side, side, 1, 1), Vec3::Zero(), kSqueezedCloth);
  std::vector<VertexId> left, right;
  for (int j = 0; j < side; ++j) {
    left.push_back(j * side);
    right.push_back(j * side + side - 1);
  }
  setup.pin(left, {{0, {}}, {0.05, {Vec3(1, 0, 0)}}});
  setup.pin(right, {{0, {}}, {0.05, {Vec3(-1, 0, 0)}}});
  yield(trial, std::move(setup), trial.steps(8, 4));
}

}  // namespace

std::vector<StabilityCase> squeeze_cases() {
  return {
      {"pinched-stop", "cloth between two closing bodies, squeeze = \"stop\"",
       "ends with a witness, and nothing has moved", pinched_stop},
      {"pinched-yield", "the same, squeeze = \"yield\"", "a body waits", pinched_yield},
      {"pressed-on-rest", "a body presses cloth onto one that rests", "a body waits", pressed_on_rest},
      {"pinched-three", "three bodies close in", "a body waits", pinched_three},
      {"spike-press", "a tip presses a vertex of the cloth onto the ground", "a body waits", spike_press},
      {"rollers", "cloth is drawn between two rollers, narrower than it is thick", "they draw it", rollers},
      {"pins-cross", "the held ends of a sheet are asked to change places through it", "they wait", pins_cross},
  };
}

}  // namespace selvage::bench
