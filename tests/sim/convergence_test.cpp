// Held against itself: distances to a refined reference shrink at the order of the method;
// docs/measurements/numerics.md has the long form of these figures.
#include <gtest/gtest.h>

#include "sim/scene/scene_reader.h"
#include "sim/step.h"

namespace selvage {

using namespace sim;

namespace {

/// A sheet of 0.4 m that hangs by its edge and falls from the horizontal for `time_s`, n vertices to a side. Limits on
/// strain are off: they switch on and off. Returns the positions of the vertices that a sheet of 5 by 5 has as well.
Positions fall(const std::string& solver, int n, int steps, double time_s, double drag_1_s) {
  const std::string text =
      "solver = \"" + solver + "\"\nstrain_limit = 0\n" + (solver == "explicit" ? "strain_rate_limit = 0\n" : "") +
      "gravity_m_s2 = [0, 0, -9.81]\ndrag_1_s = " + std::to_string(drag_1_s) +
      "\n[time]\nframes = 1\nframes_per_s = " + std::to_string(1 / time_s) +
      // A step for the solver is a 64th of the run divided by a whole number: a hair more than that gives it.
      "\nmax_step_s = " + std::to_string(time_s / 64) + "\ndynamics_step_s = " + std::to_string(time_s / steps + 1e-6) +
      "\n[[cloth]]\nsheet = {nx = " + std::to_string(n) + ", ny = " + std::to_string(n) +
      ", width_m = 0.4, height_m = 0.4}\ndensity_kg_m2 = 0.2\nmasses = \"area\"\nstretch_n_m = 40\nshear_n_m = 20\n"
      "[[cloth.pin]]\nedge = \"top\"\n";
  Simulation simulation(parse_scene(text, "fall.toml"));
  while (simulation.clock().frame() < 1) {
    const StepResult step = simulation.step();
    EXPECT_EQ(step.report.status, StepStatus::kSafe);
    EXPECT_EQ(step.report.repulsions, 0);
    EXPECT_EQ(step.dynamics.unconverged, 0);
  }
  Positions common(25, 3);
  const Eigen::Index stride = (n - 1) / 4;
  for (Eigen::Index j = 0; j < 5; ++j) {
    for (Eigen::Index i = 0; i < 5; ++i) common.row(5 * j + i) = simulation.x().row(stride * (j * n + i));
  }
  return common;
}

double distance_m(const Positions& a, const Positions& b) { return (a - b).rowwise().norm().maxCoeff(); }

}  // namespace

TEST(Convergence, BothSolversAreOfSecondOrderInTheTimeStepAndAgree) {
  const Positions reference = fall("explicit", 9, 4096, 0.2, 0.5);
  double explicit_m[2], implicit_m[2], apart_m[2];
  for (int i = 0; i < 2; ++i) {
    const Positions a = fall("explicit", 9, 256 << i, 0.2, 0.5), b = fall("implicit", 9, 256 << i, 0.2, 0.5);
    explicit_m[i] = distance_m(a, reference);
    implicit_m[i] = distance_m(b, reference);
    apart_m[i] = distance_m(a, b);
  }
  EXPECT_LT(explicit_m[0], 5e-6);
  EXPECT_LT(implicit_m[0], 5e-6);
  EXPECT_NEAR(explicit_m[0] / explicit_m[1], 4, 0.4) << explicit_m[0] << ' ' << explicit_m[1];
  EXPECT_NEAR(implicit_m[0] / implicit_m[1], 4, 0.4) << implicit_m[0] << ' ' << implicit_m[1];
  EXPECT_NEAR(apart_m[0] / apart_m[1], 4, 0.4) << apart_m[0] << ' ' << apart_m[1];
}

TEST(Convergence, TheMeshIsOfSecondOrderWhereMassesGoByArea) {
  // Enough drag that no wave front is left. Errors of h^2 against a reference of half the spacing: 15 to 3.
  const Positions reference = fall("explicit", 17, 640, 0.3, 40);
  const double coarse_m = distance_m(fall("explicit", 5, 192, 0.3, 40), reference);
  const double fine_m = distance_m(fall("explicit", 9, 384, 0.3, 40), reference);
  EXPECT_LT(coarse_m, 0.004);
  EXPECT_GT(coarse_m / fine_m, 4) << coarse_m << ' ' << fine_m;
  EXPECT_LT(coarse_m / fine_m, 7) << coarse_m << ' ' << fine_m;
}

}  // namespace selvage
