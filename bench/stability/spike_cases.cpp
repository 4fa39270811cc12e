#include <algorithm>

#include "bench/stability/cases.h"
#include "bench/stability/hard_shapes.h"
#include "bench/stability/stage.h"

namespace selvage::bench {
namespace {

constexpr double kHeight = 0.1;             // of spikes and wedges, m
const Material kRubber{1e-3, 200, 0, 0.2};  // holds a piece together, so that it arrives as a whole

/// Speeds at which a step of 10 ms goes a tenth of the height, ten heights, and a thousand.
constexpr double kSpeeds[] = {1, 100, 10'000};

/// Two pieces thrown at each other along z, one speed after the other.
void throw_together(Trial& trial, const sim::Shape& upper, const sim::Shape& lower, const Vec3& beside) {
  double closing = 0;
  for (const double speed : kSpeeds) {
    StageSetup setup;
    setup.length_m = kHeight;
    const Part above = setup.add_cloth(upper, beside + Vec3(0, 0, 0.05 * kHeight), {}, Vec3(0, 0, -speed));
    const Part below = setup.add_cloth(lower, Vec3(0, 0, -0.05 * kHeight), {}, Vec3(0, 0, speed));
    Stage stage(trial, setup);
    for (int step = 0; step < trial.steps(12, 6); ++step) stage.step();
    closing = std::max(closing, (stage.mean_velocity(below) - stage.mean_velocity(above)).z() / (2 * speed));
    stage.require_balances();
  }
  trial.at_most("closing speed left", closing, 0.999);
}

void spike_on_spike(Trial& trial) {
  const sim::Shape spike = make_spike(trial.pick(3, 8, 16), 0.3 * kHeight, kHeight);
  throw_together(trial, spike, upside_down(spike), Vec3::Zero());
}

void wedge_on_wedge(Trial& trial) {
  // Ridges that lie along each other, cross at a right angle, and cross at a thousandth of a degree.
  const sim::Shape wedge = make_wedge(trial.pick(1, 4, 8), kHeight, 0.4 * kHeight, kHeight);
  for (const double angle_deg : {0.0, 90.0, 1e-3}) {
    throw_together(trial, turned(wedge, Vec3(0, 0, angle_deg)), upside_down(wedge), Vec3::Zero());
  }
}

/// A piece of rubber thrown onto bodies that rest, one speed after the other.
void throw_onto(Trial& trial, const sim::Shape& piece, const std::vector<std::pair<sim::Shape, Vec3>>& bodies) {
  for (const double speed : kSpeeds) {
    StageSetup setup;
    setup.length_m = kHeight;
    setup.add_cloth(piece, Vec3(0, 0, 0.02 * kHeight), kRubber, Vec3(0, 0, -speed));
    for (const auto& [shape, place] : bodies) setup.add_body(shape, place);
    Stage stage(trial, setup);
    std::int64_t contacts = 0;
    for (int step = 0; step < trial.steps(12, 9); ++step) {
      const sim::CollisionStepReport& report = stage.step();
      contacts += report.repulsions + report.first_collisions;
    }
    trial.require(contacts > 0, "no contact was found");
  }
}

void spike_on_ridge(Trial& trial) {
  const sim::Shape spike = make_spike(trial.pick(3, 8, 16), 0.3 * kHeight, kHeight);
  const sim::Shape ridge = upside_down(make_wedge(trial.pick(2, 4, 8), 4 * kHeight, 4 * kHeight, kHeight));
  throw_onto(trial, spike, {{ridge, Vec3::Zero()}});
}

void spike_in_hole(Trial& trial) {
  // Four blocks leave a square hole of half the spike's width.
  const sim::Shape spike = make_spike(trial.pick(4, 8, 16), 0.4 * kHeight, kHeight);
  const double hole = 0.4 * kHeight, block = 2 * kHeight;
  const sim::Shape box = sim::make_box(Vec3(block, block, block), trial.pick(1, 2, 4));
  std::vector<std::pair<sim::Shape, Vec3>> bodies;
  for (const auto& [dx, dy] : {std::pair{1, 0}, {0, 1}, {-1, 0}, {0, -1}}) {
    // Like the blades of a wheel, so that they touch nowhere and leave no way past.
    const double away = (block + hole) / 2, aside = (block - hole) / 2;
    bodies.push_back({box, Vec3(dx * away - dy * aside, dy * away + dx * aside, -block / 2)});
  }
  throw_onto(trial, spike, bodies);
}

void spike_in_crack(Trial& trial) {
  const sim::Shape spike = make_spike(trial.pick(4, 8, 16), 0.4 * kHeight, kHeight);
  const sim::Shape box = sim::make_box(Vec3(2, 4, 2) * kHeight, trial.pick(1, 2, 4));
  throw_onto(trial, spike, {{box, Vec3(-1.1, 0, -1) * kHeight}, {box, Vec3(1.1, 0, -1) * kHeight}});
}

void wedge_in_crack(Trial& trial) {
  const sim::Shape wedge = make_wedge(trial.pick(1, 4, 8), kHeight, 0.8 * kHeight, kHeight);
  const sim::Shape box = sim::make_box(Vec3(2, 4, 2) * kHeight, trial.pick(1, 2, 4));
  throw_onto(trial, wedge, {{box, Vec3(-1.1, 0, -1) * kHeight}, {box, Vec3(1.1, 0, -1) * kHeight}});
}

}  // namespace

std::vector<StabilityCase> spike_cases() {
  return {
      {"spike-on-spike", "tip meets tip: no feature has a normal",
       "contact found at every speed, up to a thousand heights a step; momentum and energy kept", spike_on_spike},
      {"wedge-on-wedge", "ridges along each other, across, and at 0.001 degrees",
       "contact found at every speed; momentum and energy kept", wedge_on_wedge},
      {"spike-on-ridge", "a tip exactly above an edge that two faces share", "contact found at every speed",
       spike_on_ridge},
      {"spike-in-hole", "four edges at once around a tip", "contact found at every speed", spike_in_hole},
      {"spike-in-crack", "a tip between two bodies", "contact found at every speed", spike_in_crack},
      {"wedge-in-crack", "a ridge between two bodies, edges parallel to theirs", "contact found at every speed",
       wedge_in_crack},
  };
}

}  // namespace selvage::bench
