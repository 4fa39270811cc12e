#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "bench/stability/cases.h"
#include "bench/stability/hard_shapes.h"
#include "bench/stability/scene_play.h"
#include "bench/stability/stage.h"

namespace selvage::bench {
namespace {

void corner_fold(Trial& trial) {
  // Half of the sheet is asked to lie on the other half, folded along a diagonal; then to pass through it.
  const int side = trial.pick(4, 8, 14);
  StageSetup setup;
  setup.add_cloth(sim::make_sheet(side, side, 1, 1), Vec3::Zero());
  const Positions flat = setup.x;
  for (const double angle_deg : {90.0, 179.0, 180.0, 181.0, 270.0}) {
    Stage stage(trial, setup);
    Positions folded = sim::place({Vec3::Zero(), Vec3(1, 1, 0).normalized() * angle_deg}, flat);
    folded.rowwise() += stage.offset().transpose();
    for (int step = 0; step < trial.steps(4, 2); ++step) {
      Positions candidate = stage.x();
      for (Eigen::Index i = 0; i < candidate.rows(); ++i) {
        if (flat(i, 0) > flat(i, 1)) candidate.row(i) = folded.row(i);
      }
      stage.step_to(candidate);
    }
  }
  trial.at_least("steps with collisions", double(trial.report().steps_with_collisions), 2);
}

void hinge(Trial& trial) {
  // Pairs of triangles that share an edge fold shut: the angle goes to zero and beyond, exactly.
  StageSetup setup;
  const int count = trial.pick(1, 8, 40);
  sim::Shape pair;
  pair.x.resize(4, 3);
  pair.x << 0, -1, 0, 0, 1, 0, 1, 0, 0, -1, 0, 0;
  pair.triangles = {{0, 2, 1}, {0, 1, 3}};
  for (int i = 0; i < count; ++i) setup.add_cloth(pair, Vec3(4.0 * i, 0, 0));
  for (const double height : {0.5, 0.0, -0.5}) {
    Stage stage(trial, setup);
    for (int step = 0; step < trial.steps(4, 2); ++step) {
      Positions candidate = stage.x();
      for (Eigen::Index i = 3; i < candidate.rows(); i += 4) {
        candidate.row(i) = candidate.row(i - 1) + Eigen::RowVector3d(0, 0, height);
        candidate(i - 1, 2) = candidate(i - 2, 2);
      }
      stage.step_to(candidate);
    }
  }
  trial.at_least("steps with collisions", double(trial.report().steps_with_collisions), 1);
}

std::string falling_sheet(int n, const std::string& place, double fast_m_s) {
  return scene_start(0.3, 0.4) + fmt::format(R"(
[[cloth]]
sheet = {{nx = {}, ny = {}, width_m = 1, height_m = 1}}
{}
velocity_m_s = [0, 0, {}]
density_kg_m2 = 0.2
stretch_n_m = 40
shear_n_m = 12
bend_n_m = 0.4
damping_ratio = 0.2
[[body]]
sheet = {{nx = 2, ny = 2, width_m = 8, height_m = 8}}
)",
                                             n, n, place, -fast_m_s);
}

/// On the way: of 16 edges-on a tenth of a millimetre apart springs were compressed by 0.15 to 0.37 for a moment, while
/// the heap sank. Where contact may press springs as it will, fast ones lose 0.95 of their length.
void fall(Trial& trial, const std::string& place, double fast_m_s) {
  ScenePlay play(trial, falling_sheet(trial.pick(8, 12, 16), place, fast_m_s), 1);
  double most = 0;
  for (int frame = 1; frame <= (trial.variant().quick ? 2 : 60); ++frame) {
    play.run_to(frame / 30.0);
    most = std::max(most, play.largest_strain());
  }
  trial.at_most("largest strain on the way", most, 0.5);
  trial.at_most("largest strain at the end", play.largest_strain(), 0.3);
  const auto cloth = play.x().topRows(play.simulation().world().cloth_vertex_count);
  trial.at_least("height above the ground, m", cloth.col(2).minCoeff() - play.offset().z(), 0);
}

void own_corner(Trial& trial) { fall(trial, "position_m = [0, 0, 0.72]\nrotation_deg = [86.1, 35.66, 35.66]", 0); }
void edge_on(Trial& trial) { fall(trial, "position_m = [0, 0, 0.51]\nrotation_deg = [90, 0, 0]", 0); }
void edge_on_fast(Trial& trial) { fall(trial, "position_m = [0, 0, 0.51]\nrotation_deg = [89, 0, 0]", 30); }

void bellows(Trial& trial) {
  // A pleated sheet is pressed flat along its length, pleats of a centimetre into a length of less than its thickness.
  const int pleats = trial.pick(4, 10, 24), rows = 3;
  sim::Shape sheet = sim::make_sheet(2 * pleats + 1, rows, 1, 0.2);
  for (Eigen::Index i = 0; i < sheet.x.rows(); ++i) {
    const auto column = i % (2 * pleats + 1);
    sheet.x(i, 0) = 0.02 * static_cast<double>(column);
    sheet.x(i, 2) = column % 2 == 0 ? 0 : 0.1;
  }
  StageSetup setup;
  setup.add_cloth(sheet, Vec3::Zero());
  setup.collision.repulsion = false;
  Stage stage(trial, setup);
  for (int step = 0; step < trial.steps(10, 3); ++step) {
    Positions candidate = stage.x();
    const double middle = candidate.col(0).mean();
    candidate.col(0) = middle + 1e-3 * (candidate.col(0).array() - middle);
    stage.step_to(candidate);
  }
  trial.at_least("steps with collisions", double(trial.report().steps_with_collisions), 1);
}

}  // namespace

std::vector<StabilityCase> fold_cases() {
  return {
      {"corner-fold", "a sheet folded along its diagonal by 179, 180, 181 and 270 degrees in a step",
       "halves stay apart", corner_fold},
      {"hinge", "two faces that share an edge fold to an angle of zero, and beyond", "the angle stays above zero",
       hinge},
      {"bellows", "pleats pressed into a thousandth of their length", "pleats stay apart", bellows},
      {"own-corner", "cloth falls on its own corner",
       "strain at most 0.5 on the way and 0.3 in the end, above the ground", own_corner},
      {"edge-on", "cloth falls on its edge", "strain at most 0.5 on the way and 0.3 in the end, above the ground",
       edge_on},
      {"edge-on-fast", "the same at 30 m/s, half its length a frame",
       "strain at most 0.5 on the way and 0.3 in the end, above the ground", edge_on_fast},
  };
}

}  // namespace selvage::bench
