#include "sim/repair/relax_springs.h"

#include <cmath>
#include <optional>

#include <gtest/gtest.h>

#include "sim/cloth.h"
#include "sim/springs/spring_strain.h"
#include "tests/sim/step_scene.h"

namespace selvage::sim::testbed {
namespace {

constexpr double kLimit = 0.1;

/// A sheet of 0.4 m, pinned at a vertex in its middle, over a ball that it does not touch.
struct SheetOverBall {
  static constexpr VertexId kPin = 65;
  StepScene scene;
  std::optional<SpringSystem> made_springs;
  StepScene::Part cloth;

  SheetOverBall() {
    const Shape sheet = make_sheet(12, 12, 0.4, 0.4);
    cloth = scene.add(sheet, Vec3::Zero());
    scene.add(make_sphere(0.12, 2), Vec3(0, 0, -0.15), 0);
    ClothSpec spec;
    spec.surface = SheetSpec{12, 12, 0.4, 0.4};
    spec.density_kg_m2 = 0.2;
    spec.stretch_n_m = 60;
    spec.shear_n_m = 20;
    spec.bend_n_m = 0.3;
    spec.damping_ratio = 0.1;
    const std::vector<double> mass = cloth_masses(spec, sheet);
    made_springs.emplace(make_springs(spec, sheet, mass), cloth.end);
    for (VertexId v = 0; v < cloth.end; ++v) {
      scene.inverse_mass[static_cast<std::size_t>(v)] = v == kPin ? 0 : 1 / mass[static_cast<std::size_t>(v)];
    }
    scene.options.thickness_m = 0.003;
  }

  [[nodiscard]] const SpringSystem& springs() const { return *made_springs; }

  /// Three times as wide around the pin, and pulled down over the ball, which it then surrounds as far as its equator.
  void stretch() {
    const Eigen::RowVector3d pin = scene.V_t0.row(kPin);
    for (VertexId v = 0; v < cloth.end; ++v) {
      const Eigen::RowVector3d away = 3 * (scene.V_t0.row(v) - pin);
      scene.V_t0.row(v) = pin + away - Eigen::RowVector3d(0, 0, 0.2 * std::min(1.0, away.squaredNorm() / 0.09));
    }
  }

  [[nodiscard]] RelaxedSprings relax() const {
    const Mesh mesh = scene.mesh();
    CollisionStep step(mesh, scene.options);
    return relax_springs(scene.V_t0, springs(), nullptr, step, scene.bodies(), kLimit);
  }
};

/// Of structural and shear springs.
double sum_beyond_limit(const SpringSystem& springs, const Positions& x) {
  double sum = 0;
  for (const Spring& spring : springs.springs()) {
    if (spring.kind == SpringKind::kBending) continue;
    const double length_m = (x.row(spring.b) - x.row(spring.a)).norm();
    sum += std::max(0.0, length_m / spring.rest_length_m - 1 - kLimit);
  }
  return sum;
}

TEST(RelaxSprings, StretchedClothDrawsTogetherAndTouchesNothing) {
  SheetOverBall start;
  start.stretch();
  ASSERT_EQ(exact_defect(start.scene, start.scene.V_t0), "");
  ASSERT_GT(largest_elongation(start.springs(), start.scene.V_t0), 1.9);
  const RelaxedSprings relaxed = start.relax();
  EXPECT_EQ(exact_defect(start.scene, relaxed.x), "");
  EXPECT_LE(largest_elongation(start.springs(), relaxed.x), kLimit);
  EXPECT_EQ(relaxed.largest_strain, most_strained(start.springs(), relaxed.x).strain);
  EXPECT_GT(relaxed.steps, 1);
  EXPECT_LT(relaxed.steps, kMaxRelaxSteps);
  EXPECT_EQ(relaxed.x.row(SheetOverBall::kPin), start.scene.V_t0.row(SheetOverBall::kPin));
  for (Eigen::Index v = start.cloth.end; v < relaxed.x.rows(); ++v) {
    EXPECT_EQ(relaxed.x.row(v), start.scene.V_t0.row(v)) << "a body";
  }
}

TEST(RelaxSprings, WhatIsWithinTheLimitStaysWhereItIs) {
  SheetOverBall start;
  start.scene.V_t0.topRows(start.cloth.end) *= 1.09;
  const RelaxedSprings relaxed = start.relax();
  EXPECT_EQ(relaxed.x, start.scene.V_t0);
  EXPECT_EQ(relaxed.steps, 0);
}

TEST(RelaxSprings, WhatIsPressedSpreadsOut) {
  SheetOverBall start;
  const Eigen::RowVector3d pin = start.scene.V_t0.row(SheetOverBall::kPin);
  for (VertexId v = 0; v < start.cloth.end; ++v) start.scene.V_t0.row(v) = pin + 0.3 * (start.scene.V_t0.row(v) - pin);
  const RelaxedSprings relaxed = start.relax();
  EXPECT_EQ(exact_defect(start.scene, relaxed.x), "");
  EXPECT_GT(relaxed.steps, 0);
  EXPECT_LE(std::abs(most_strained(start.springs(), relaxed.x).strain), kLimit);
}

/// Pins hold the cloth stretched: all in all it comes nearer to the limit, and the rest is left.
TEST(RelaxSprings, EndsWhereTheLimitCannotBeReached) {
  SheetOverBall start;
  start.stretch();
  for (const VertexId pin : {0, 11, 132, 143}) start.scene.inverse_mass[static_cast<std::size_t>(pin)] = 0;
  const RelaxedSprings relaxed = start.relax();
  EXPECT_EQ(exact_defect(start.scene, relaxed.x), "");
  EXPECT_GT(largest_elongation(start.springs(), relaxed.x), kLimit);
  EXPECT_LT(sum_beyond_limit(start.springs(), relaxed.x), 0.7 * sum_beyond_limit(start.springs(), start.scene.V_t0));
  EXPECT_GT(relaxed.steps, 0);
  EXPECT_LT(relaxed.steps, kMaxRelaxSteps) << "not for less than a thousandth";
  for (const VertexId pin : {0, 11, 132, 143}) EXPECT_EQ(relaxed.x.row(pin), start.scene.V_t0.row(pin));
}

/// One spring that pins hold at three times its length: what the others gain by it in later steps is nothing.
TEST(RelaxSprings, EndsWhereAStepGainsLittle) {
  SheetOverBall start;
  constexpr VertexId kBeside = SheetOverBall::kPin + 1;
  start.scene.inverse_mass[kBeside] = 0;
  start.scene.V_t0.row(kBeside) +=
      2 * (start.scene.V_t0.row(kBeside) - start.scene.V_t0.row(SheetOverBall::kPin)) + Eigen::RowVector3d(0, 0, 0.01);
  ASSERT_EQ(exact_defect(start.scene, start.scene.V_t0), "");
  const RelaxedSprings relaxed = start.relax();
  EXPECT_EQ(exact_defect(start.scene, relaxed.x), "");
  EXPECT_GT(relaxed.steps, 0);
  EXPECT_LT(relaxed.steps, kMaxRelaxSteps);
}

}  // namespace
}  // namespace selvage::sim::testbed
