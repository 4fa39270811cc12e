#include <algorithm>

#include "bench/stability/cases.h"
#include "bench/stability/hard_shapes.h"
#include "bench/stability/stage.h"

namespace selvage::bench {
namespace {

/// Three sheets above each other, 1 cm apart.
StageSetup three_sheets(Trial& trial) {
  StageSetup setup;
  const int side = trial.pick(4, 8, 16);
  for (int layer = 0; layer < 3; ++layer) {
    setup.add_cloth(sim::make_sheet(side, side, 1, 1), Vec3(0.013 * layer, 0.007 * layer, 0.01 * layer));
  }
  return setup;
}

/// Candidates that flatten everything, step after step: `flatten` maps a position to where it should go.
template <class Flatten>
void collapse(Trial& trial, Flatten flatten) {
  Stage stage(trial, three_sheets(trial));
  for (int step = 0; step < trial.steps(8, 2); ++step) {
    Positions candidate = stage.x();
    for (Eigen::Index i = 0; i < candidate.rows(); ++i) {
      candidate.row(i) = (flatten(Vec3(candidate.row(i).transpose() - stage.offset())) + stage.offset()).transpose();
    }
    stage.step_to(candidate);
  }
  trial.at_least("steps with collisions", double(trial.report().steps_with_collisions), 1);
}

void collapse_to_point(Trial& trial) {
  collapse(trial, [](const Vec3&) { return Vec3(0.25, 0.25, 0.25); });
}
void collapse_to_line(Trial& trial) {
  collapse(trial, [](const Vec3& x) { return Vec3(x.x(), 0.5 * x.x(), 0.25 * x.x()); });
}
void collapse_to_plane(Trial& trial) {
  collapse(trial, [](const Vec3& x) { return Vec3(x.x(), x.y(), 0); });
}

void inside_out(Trial& trial) {
  StageSetup setup;
  setup.add_cloth(sim::make_sphere(1, trial.pick(0, 1, 2)), Vec3::Zero());
  Stage stage(trial, setup);
  for (int step = 0; step < trial.steps(8, 3); ++step) {
    const Vec3 centre = stage.x().colwise().mean();
    stage.step_to((-stage.x()).rowwise() + 2 * centre.transpose());
  }
  trial.at_least("steps with collisions", double(trial.report().steps_with_collisions), 1);
}

}  // namespace

std::vector<StabilityCase> degenerate_cases() {
  return {
      {"collapse-to-point", "all candidates are one point", "no face loses its area", collapse_to_point},
      {"collapse-to-line", "all candidates lie on a line", "no face loses its area", collapse_to_line},
      {"collapse-to-plane", "three layers are asked into one plane", "layers stay apart", collapse_to_plane},
      {"inside-out", "a closed surface is asked to pass through its centre", "it does not", inside_out},
  };
}

}  // namespace selvage::bench
