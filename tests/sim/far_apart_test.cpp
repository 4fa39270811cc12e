// Cloth that meets nothing moves as if it were alone, whatever other cloth of the scene meets or bears.
#include <algorithm>
#include <string>

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include "sim/scene/scene_reader.h"
#include "sim/step.h"

namespace selvage::sim::testbed {
namespace {

std::string solved_by(const std::string& solver) { return "solver = \"" + solver + "\"\n"; }

/// The first `rows` vertices after `frames`.
Positions first_rows_after(const std::string& scene, std::int64_t frames, Eigen::Index rows) {
  Simulation simulation(parse_scene(scene, "far.toml"));
  while (simulation.clock().frame() < frames) EXPECT_EQ(simulation.step().report.status, StepStatus::kSafe);
  return simulation.x().topRows(rows);
}

/// Along and across the squares of a sheet of 12 x 12 vertices, a metre wide.
double largest_strain(const Positions& x) {
  constexpr double kRest_m = 1.0 / 11;
  double largest = 0;
  for (Eigen::Index i = 0; i < 144; ++i) {
    if (i % 12 != 11) largest = std::max(largest, (x.row(i + 1) - x.row(i)).norm() / kRest_m - 1);
    if (i < 132) largest = std::max(largest, (x.row(i + 12) - x.row(i)).norm() / kRest_m - 1);
  }
  return largest;
}

}  // namespace

// In backward Euler for all cloth, once any touched anything, the swing lost half of its energy in four seconds.
TEST(FarApart, ImplicitClothDoesNotFeelThatOtherClothTouches) {
  const auto scene = [](const std::string& height_m) {
    return solved_by("implicit") + R"(
gravity_m_s2 = [0, 0, -9.81]
[time]
frames = 24
max_step_s = 0.016666666666666666
min_step_s = 0.016666666666666666
[[cloth]]
name = "swing"
sheet = {nx = 4, ny = 4, width_m = 0.3, height_m = 0.3}
rotation_deg = [45, 0, 0]
density_kg_m2 = 0.2
stretch_n_m = 500
shear_n_m = 160
[[cloth.pin]]
edge = "top"
[[cloth]]
name = "flies"
sheet = {nx = 3, ny = 3, width_m = 0.2, height_m = 0.2}
position_m = [10, 0, 0]
density_kg_m2 = 0.2
stretch_n_m = 50
velocity_m_s = [0, 0, 5]
[[cloth]]
name = "lies"
sheet = {nx = 3, ny = 3, width_m = 0.2, height_m = 0.2}
position_m = [30, 0, )" +
           height_m +
           R"(]
density_kg_m2 = 0.2
stretch_n_m = 50
[[body]]
sheet = {nx = 2, ny = 2, width_m = 1, height_m = 1}
position_m = [30, 0, 0]
)";
  };
  const Positions touches = first_rows_after(scene("0.001"), 24, 25), falls = first_rows_after(scene("40"), 24, 25);
  EXPECT_LT((touches - falls).cwiseAbs().maxCoeff(), 1e-8);
  {
    const oneapi::tbb::global_control one(oneapi::tbb::global_control::max_allowed_parallelism, 1);
    EXPECT_EQ(first_rows_after(scene("0.001"), 24, 25), touches) << "on one thread";
  }
  // 5 t - g t^2 / 2, as both stages have it.
  EXPECT_NEAR(touches.bottomRows(9).col(2).mean(), 5 * 0.8 - 9.81 * 0.8 * 0.8 / 2, 1e-9);
}

// What the limit finds to a share of the sum of all, it found to less where another cloth had the most of it.
TEST(FarApart, LimitsOnStrainAreFoundForEachClothByItself) {
  const auto scene = [](const std::string& solver, const std::string& pulled_m) {
    return solved_by(solver) + R"(
gravity_m_s2 = [0, 0, -9.81]
strain_limit = 0.1
[time]
frames = 8
max_step_s = 0.0041666667
min_step_s = 0.0041666667
[[cloth]]
name = "hangs"
sheet = {nx = 12, ny = 12, width_m = 1, height_m = 1}
rotation_deg = [90, 0, 0]
density_kg_m2 = 1
stretch_n_m = 30
shear_n_m = 10
damping_ratio = 0.1
[[cloth.pin]]
vertices = [132, 143]
[[cloth]]
name = "pulled"
sheet = {nx = 10, ny = 10, width_m = 0.5, height_m = 0.5}
position_m = [5, 0, 2]
density_kg_m2 = 0.2
stretch_n_m = 50
shear_n_m = 20
[[cloth.pin]]
edge = "left"
[[cloth.pin]]
edge = "right"
key = [{time_s = 0}, {time_s = 0.5, position_m = [)" +
           pulled_m + ", 0, 0]}]\n";
  };
  const Positions beside = first_rows_after(scene("explicit", "1"), 8, 144);
  EXPECT_LT((beside - first_rows_after(scene("explicit", "0"), 8, 144)).cwiseAbs().maxCoeff(), 1e-8);
  // Where pressed cloth buckles the implicit equations have several solutions, so only the strains are alike.
  const double with = largest_strain(first_rows_after(scene("implicit", "1"), 24, 144));
  EXPECT_NEAR(with, largest_strain(first_rows_after(scene("implicit", "0"), 24, 144)), 0.04) << "by 0.18 otherwise";
}

}  // namespace selvage::sim::testbed
