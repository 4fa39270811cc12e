// What a step may leave behind: docs/measurements/simulator-speed.md and stability.md say what it is worth.
#include "sim/step_allowance.h"

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "sim/contact_energy.h"
#include "sim/scene/scene_reader.h"

namespace selvage {

using namespace sim;

namespace {

constexpr double kEdge_m = 0.1;

/// A flat sheet with springs along its edges alone, and what its steps may leave behind.
struct Allowed {
  Scene scene;
  World world{build_world(scene)};
  SurfaceParts parts{world.mesh};
  StepAllowance allowance{scene, world, parts};

  Allowed(int nx, int ny, const std::string& head = "")
      : scene(parse_scene(
            head + "strain_limit = 0.1\n[time]\nframes = 1\n[[cloth]]\nsheet = {nx = " + std::to_string(nx) +
                ", ny = " + std::to_string(ny) + ", width_m = " + std::to_string(kEdge_m * (nx - 1)) +
                ", height_m = " + std::to_string(kEdge_m * (ny - 1)) + "}\ndensity_kg_m2 = 0.2\nstretch_n_m = 40\n",
            "allowed.toml")) {}

  [[nodiscard]] std::int64_t vertices() const { return world.cloth_vertex_count; }
};

/// Of a sheet of 2 by 2 vertices.
struct Energies : Allowed {
  explicit Energies(const std::string& head = "") : Allowed(2, 2, head) {}

  /// Whether it is too much that collisions put `gain_j` into the springs of cloth that moves with `kinetic_j`.
  [[nodiscard]] bool is_too_much(double gain_j, double kinetic_j, double dt_s, bool is_new) const {
    const Positions& rest = world.x_t0;
    double mass_kg = 0;
    for (const double w : world.inverse_mass) mass_kg += 1 / w;
    Positions v = Positions::Zero(rest.rows(), 3);
    v.col(2).setConstant(std::sqrt(2 * kinetic_j / mass_kg));
    // Two of the four springs become longer alike.
    const double longer_m = std::sqrt(gain_j / world.springs.springs().front().stiffness_n_m);
    Positions x = rest;
    for (Eigen::Index i = 0; i < x.rows(); ++i) {
      if (rest(i, 0) > rest.col(0).mean()) x(i, 0) += longer_m;
    }
    return allowance.energizes({rest, x, v, {}, {}}, world.inverse_mass, dt_s, is_new);
  }
};

CollisionStepReport with_collisions(std::int64_t count) {
  CollisionStepReport report;
  report.first_collisions = count;
  return report;
}

}  // namespace

TEST(StepAllowance, BearsACollisionFor400VerticesAndAnEighthOfItInAGoodStep) {
  for (const auto& [nx, ny] : {std::array{10, 10}, {21, 19}, {20, 20}, {80, 40}, {80, 80}}) {
    const Allowed allowed(nx, ny);
    SCOPED_TRACE(allowed.vertices());
    const std::int64_t most = allowed.vertices() / 400, few = most / 8;
    EXPECT_EQ(allowed.allowance.patience().collisions, most);
    EXPECT_TRUE(allowed.allowance.is_good(with_collisions(few)));
    EXPECT_FALSE(allowed.allowance.is_good(with_collisions(few + 1)));
  }
}

TEST(StepAllowance, HalfTheStepBearsTwiceAsMuchBeforeTheLastRunUpToFourTimes) {
  const Allowed allowed(80, 80);  // 2 in the longest step
  const auto borne = [&](std::int32_t halvings) { return allowed.allowance.patience_before_last(halvings).collisions; };
  EXPECT_EQ((std::array{borne(0), borne(1), borne(2), borne(3), borne(40)}),
            (std::array<std::int64_t, 5>{2, 4, 8, 8, 8}));
  EXPECT_EQ(allowed.allowance.patience_before_last(1).impulse_rounds, allowed.allowance.patience().impulse_rounds);
}

TEST(StepAllowance, HalfTheStepBearsTwiceAsManyOverstrainedSpringsUpToFourTimes) {
  const Allowed allowed(21, 20);  // 1 in the longest step
  const Positions& rest = allowed.world.x_t0;
  // A vertex of the lower edge that is drawn down strains the spring above it: those beside it by 2 %.
  const auto with_strained = [&](int count) {
    Positions x = rest;
    int left = count;
    for (Eigen::Index i = 0; i < x.rows() && left > 0; ++i) {
      if (rest(i, 1) > rest.col(1).minCoeff() + kEdge_m / 2 || std::lround(rest(i, 0) / kEdge_m) % 2 != 0) continue;
      x(i, 1) -= 0.2 * kEdge_m;
      --left;
    }
    EXPECT_EQ(left, 0);
    return x;
  };
  const auto overstrains = [&](int count, std::int32_t halvings) {
    return allowed.allowance.overstrains(rest, rest, with_strained(count), halvings);
  };
  std::int32_t halvings = 0;
  for (const int borne : {1, 2, 4, 4}) {
    EXPECT_FALSE(overstrains(borne, halvings)) << halvings;
    EXPECT_TRUE(overstrains(borne + 1, halvings)) << halvings;
    ++halvings;
  }
  const Positions strained = with_strained(8);
  EXPECT_FALSE(allowed.allowance.overstrains(rest, strained, strained, 0)) << "by the dynamics";
  EXPECT_FALSE(allowed.allowance.overstrains(strained, rest, strained, 0)) << "as it was";
}

TEST(StepAllowance, ANewContactMayAddEightPercentOfTheEnergyAndHalfAPercentInLongSteps) {
  const Energies cloth;
  for (const double dt_s : {1e-3, 1.0 / 60}) {
    EXPECT_FALSE(cloth.is_too_much(0.0799, 1, dt_s, true)) << dt_s;
    EXPECT_TRUE(cloth.is_too_much(0.0801, 1, dt_s, true)) << dt_s;
  }
  for (const double dt_s : {1.02 / 60, 1.0 / 30}) {
    EXPECT_FALSE(cloth.is_too_much(0.00499, 1, dt_s, true)) << dt_s;
    EXPECT_TRUE(cloth.is_too_much(0.00501, 1, dt_s, true)) << dt_s;
  }
}

TEST(StepAllowance, OtherwiseContactMayAddAsMuchEnergyAsThereIs) {
  for (const double dt_s : {1e-3, 1.0 / 30}) {
    const Energies cloth, implicit("solver = \"implicit\"\n");
    EXPECT_FALSE(cloth.is_too_much(0.999, 1, dt_s, false)) << dt_s;
    EXPECT_TRUE(cloth.is_too_much(1.001, 1, dt_s, false)) << dt_s;
    for (const bool is_new : {false, true}) {
      EXPECT_FALSE(implicit.is_too_much(0.999, 1, dt_s, is_new)) << dt_s;
      EXPECT_TRUE(implicit.is_too_much(1.001, 1, dt_s, is_new)) << dt_s;
    }
  }
}

TEST(StepAllowance, ClothAtRestHasTheEnergyThatItFallsByInAStep) {
  const double dt_s = 0.01, fall_m_s = 10 * dt_s;
  const Energies cloth("gravity_m_s2 = [0, 6, -8]\n");
  double mass_kg = 0;
  for (const double w : cloth.world.inverse_mass) mass_kg += 1 / w;
  const double falls_j = mass_kg * fall_m_s * fall_m_s / 2;
  EXPECT_FALSE(cloth.is_too_much(0.999 * falls_j, 0, dt_s, false));
  EXPECT_TRUE(cloth.is_too_much(1.001 * falls_j, 0, dt_s, false));
}

}  // namespace selvage
