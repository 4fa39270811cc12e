#include <cmath>
#include <random>

#include <fmt/format.h>

#include "bench/stability/cases.h"
#include "bench/stability/hard_shapes.h"
#include "bench/stability/scene_play.h"
#include "bench/stability/stage.h"

namespace selvage::bench {
namespace {

/// A sheet thrown onto another with springs, friction and gravity, all lengths times `unit`.
StageSetup thrown_sheet(int side, double unit) {
  StageSetup setup;
  setup.length_m = unit;
  setup.dt_s = 0x1p-7;
  setup.collision.thickness_m = unit * 0x1p-8;
  setup.collision.tolerance_m = unit * 0x1p-20;
  setup.collision.friction_static = setup.collision.friction_kinetic = 0.3;
  setup.gravity_m_s2 = Vec3(0, 0, -8 * unit);
  const sim::Shape sheet = sim::make_sheet(side, side, unit, unit);
  const Material cloth{1e-3, 50, 1, 0.2};
  setup.add_cloth(sheet, Vec3::Zero(), cloth);
  setup.add_cloth(sheet, Vec3(0.07, 0.13, 0x1p-5) * unit, cloth, Vec3(1, 0, -6) * unit);
  return setup;
}

Positions run_thrown_sheet(Trial& trial, double unit) {
  Stage stage(trial, thrown_sheet(trial.pick(4, 7, 12), unit));
  for (int step = 0; step < trial.steps(20, 4); ++step) stage.step();
  trial.require(trial.report().steps_with_collisions > 0, "no contact was found");
  return stage.x();
}

void powers_of_two(Trial& trial) {
  const Positions at_one = run_thrown_sheet(trial, 1);
  for (const int exponent : {-300, -60, -10, 20, 300}) {
    const Positions scaled = run_thrown_sheet(trial, std::ldexp(1.0, exponent));
    // At the far offset a million lengths away scales too, so the bits must be the same there.
    const bool same = (scaled * std::ldexp(1.0, -exponent)).cwiseEqual(at_one).all();
    trial.require(same, fmt::format("lengths times 2^{} gave other bits", exponent));
  }
}

void huge(Trial& trial) {
  // Without the springs, whose squares do not fit into a double.
  const double unit = 0x1p+900;
  StageSetup setup;
  setup.length_m = unit;
  setup.collision.thickness_m = unit * 0x1p-8;
  setup.collision.tolerance_m = unit * 0x1p-20;
  const sim::Shape sheet = sim::make_sheet(trial.pick(4, 7, 12), trial.pick(4, 7, 12), unit, unit);
  setup.add_cloth(sheet, Vec3::Zero());
  setup.add_cloth(sheet, Vec3(0.07, 0.13, 0x1p-5) * unit, {}, Vec3(1, 0, -6) * unit);
  Stage stage(trial, setup);
  for (int step = 0; step < trial.steps(10, 3); ++step) stage.step_to(stage.x() + setup.dt_s * stage.v());
  trial.at_least("steps with collisions", double(trial.report().steps_with_collisions), 1);
}

void subnormal(Trial& trial) {
  StageSetup setup;
  const double unit = 0x1p-1060;  // 2^14 of the smallest double
  setup.length_m = unit;
  setup.collision.thickness_m = setup.collision.tolerance_m = 0;
  const int side = trial.pick(3, 5, 9);
  for (int layer = 0; layer < 3; ++layer) {
    setup.add_cloth(sim::make_sheet(side, side, unit, unit), Vec3(0, 0, layer * 0x1p-1072));
  }
  Stage stage(trial, setup);
  for (int step = 0; step < trial.steps(6, 2); ++step) {
    Positions candidate = stage.x();
    candidate.col(2) = stage.offset().z() * 2 + 0x1p-1071 - candidate.col(2).array();  // layers are asked to swap
    stage.step_to(candidate);
  }
  trial.at_least("steps with collisions", double(trial.report().steps_with_collisions), 1);
}

void coarse_lattice(Trial& trial) {
  // Layers four units of the last place apart, asked to swap.
  StageSetup setup;
  setup.collision.thickness_m = setup.collision.tolerance_m = 0;
  const double base = 0x1p+30, unit_in_last_place = 0x1p-22;
  const int side = trial.pick(3, 5, 9);
  for (int layer = 0; layer < 4; ++layer) {
    const Vec3 place = Vec3(base, base, base + layer * 4 * unit_in_last_place);
    setup.add_cloth(sim::make_sheet(side, side, 0x1p-2, 0x1p-2), place);
  }
  Stage stage(trial, setup);
  for (int step = 0; step < trial.steps(6, 2); ++step) {
    Positions candidate = stage.x();
    const double lowest = candidate.col(2).minCoeff(), highest = candidate.col(2).maxCoeff();
    candidate.col(2) = lowest + (highest - candidate.col(2).array());
    stage.step_to(candidate);
  }
  trial.at_least("steps with collisions", double(trial.report().steps_with_collisions), 1);
}

void float32_lattice(Trial& trial) {
  StageSetup setup;
  setup.collision.precision = sim::CollisionOptions::Precision::kFloat32;
  // Lattices of 2^-24 at 1 and 2^-4 at 10^6, so the layers stand wide enough for either.
  const double gap = trial.variant().far ? 1 : 0x1p-20;
  const double length = trial.variant().far ? 64 : 1;
  setup.collision.thickness_m = setup.collision.tolerance_m = 0;
  const int side = trial.pick(3, 5, 9);
  for (int layer = 0; layer < 3; ++layer) {
    setup.add_cloth(sim::make_sheet(side, side, length, length), Vec3(0, 0, layer * gap), {},
                    Vec3(0, 0, -50.0 * layer * length));
  }
  setup.x = setup.x.cast<float>().cast<double>();
  Stage stage(trial, setup);
  for (int step = 0; step < trial.steps(10, 3); ++step) {
    stage.step();
    trial.require((stage.x().cast<float>().cast<double>().array() == stage.x().array()).all(), "off the lattice");
  }
  trial.at_least("steps with collisions", double(trial.report().steps_with_collisions), 1);
}

void blow_up(Trial& trial) {
  StageSetup setup;
  const int side = trial.pick(3, 6, 12);
  setup.add_cloth(sim::make_sheet(side, side, 1, 1), Vec3::Zero());
  setup.add_cloth(sim::make_sheet(side, side, 1, 1), Vec3(0.1, 0.1, 0.01));
  Stage stage(trial, setup);
  std::mt19937_64 engine(11);
  const auto unit = [&engine] { return std::ldexp(static_cast<double>(engine() >> 11), -52) - 1; };
  for (const double reach : {1e6, 1e100, 1e300, 1e308}) {
    Positions candidate = stage.x();
    for (Eigen::Index i = 0; i < candidate.size(); ++i) candidate.data()[i] = reach * unit();
    stage.step_to(candidate);
    trial.require(stage.v().allFinite(), "a velocity is not finite");
  }
  trial.at_least("candidates cut back", double(trial.report().cut_candidates), 1);
}

/// The same drape in other units of length: `unit` is a metre.
void drape_in_units(Trial& trial, double unit) {
  const int n = trial.pick(8, 12, 16);
  ScenePlay play(trial,
                 fmt::format(R"(
gravity_m_s2 = [0, 0, {}]
drag_1_s = 0.5
[time]
frames_per_s = 30
frames = 60
max_step_s = 0.0166667
[collision]
thickness_m = {}
tolerance_m = {}
friction_static = 0.4
[[cloth]]
sheet = {{nx = {}, ny = {}, width_m = {}, height_m = {}}}
position_m = [0, 0, {}]
rotation_deg = [0, 0, 15]
density_kg_m2 = {}
stretch_n_m = 40
shear_n_m = 12
bend_n_m = 0.4
damping_ratio = 0.2
[[body]]
sphere = {{radius_m = {}, subdivisions = 2}}
[[body]]
name = "ground"
sheet = {{nx = 2, ny = 2, width_m = {}, height_m = {}}}
position_m = [0, 0, {}]
)",
                             -9.81 * unit, 4e-3 * unit, 1e-6 * unit, n, n, unit, unit, 0.28 * unit, 0.2 / (unit * unit),
                             0.25 * unit, 8 * unit, 8 * unit, -0.3 * unit),
                 unit);
  play.run_to(trial.variant().quick ? 0.1 : 1);
  trial.at_most("largest strain", play.largest_strain(), 0.2);
  trial.at_most("steps with the fail-safe", double(trial.report().fail_safe_steps), 0);
}

void millimetres(Trial& trial) { drape_in_units(trial, 1e-3); }
void metres(Trial& trial) { drape_in_units(trial, 1); }
void kilometres(Trial& trial) { drape_in_units(trial, 1e3); }

}  // namespace

std::vector<StabilityCase> scale_cases() {
  return {
      {"powers-of-two", "one fall with all lengths times 2^-300 to 2^300", "the same bits, scaled", powers_of_two},
      {"huge", "lengths of 2^900", "contact found", huge},
      {"subnormal", "lengths of 2^-1060, gaps of four of the smallest doubles", "contact found", subnormal},
      {"coarse-lattice", "layers four units in the last place apart, at 2^30", "contact found", coarse_lattice},
      {"float32-lattice", "layers a few float32 apart", "every state on the lattice", float32_lattice},
      {"blow-up", "random candidates up to 1e308", "cut back, velocities finite", blow_up},
      {"drape-1mm", "cloth of a millimetre over a ball", "strain at most 0.2, no fail-safe", millimetres},
      {"drape-1m", "cloth of a metre over a ball", "strain at most 0.2, no fail-safe", metres},
      {"drape-1km", "cloth of a kilometre over a ball", "strain at most 0.2, no fail-safe", kilometres},
  };
}

}  // namespace selvage::bench
