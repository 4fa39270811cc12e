#include "sim/springs/strain.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/sim/dynamics/plain_forces.h"
#include "tests/sim/random_cloth.h"

namespace selvage {

using namespace sim;
using testing::random_cloth;

namespace {

using Limiter = std::int64_t (*)(const SpringSystem&, std::span<const double>, const Positions&, double,
                                 const StrainLimits&, Positions&);

template <class Limit>
std::int64_t limit(const Positions& x, double dt_s, Positions& v, Limit limiter) {
  const LaneVectors x_t0 = testing::to_lanes(x);
  LaneVectors v_lanes = testing::to_lanes(v), x_t1 = testing::to_lanes(x + dt_s * v);
  const std::int64_t impulses = limiter(LimitedMotion{x_t0, dt_s, v_lanes, x_t1});
  v = testing::from_lanes(v_lanes);
  EXPECT_LE((testing::from_lanes(x_t1) - (x + dt_s * v)).norm(), 1e-15 * (1 + x.norm()));
  return impulses;
}

std::int64_t limit_strain(const SpringSystem& springs, std::span<const double> inverse_mass, const Positions& x,
                          double dt_s, const StrainLimits& limits, Positions& v) {
  return limit(x, dt_s, v, [&](const LimitedMotion& motion) {
    return StrainLimiter(springs, limits).limit_strain(inverse_mass, motion);
  });
}

std::int64_t limit_strain_rate(const SpringSystem& springs, std::span<const double> inverse_mass, const Positions& x,
                               double dt_s, const StrainLimits& limits, Positions& v) {
  return limit(x, dt_s, v, [&](const LimitedMotion& motion) {
    return StrainLimiter(springs, limits).limit_strain_rate(inverse_mass, motion);
  });
}

// A spring of rest length 1 along x between masses of 1 and 3.
struct Pair {
  SpringSystem springs{{Spring{0, 1, SpringKind::kStructural, 1.0, 1, 0}}, 2};
  std::vector<double> inverse_mass = {1, 1.0 / 3};
  Positions x{2, 3}, v{2, 3};

  Pair(double length, double rate) {
    x << 0, 0, 0, length, 0, 0;
    v << -0.75 * rate, 0, 0, 0.25 * rate, 0, 0;  // no linear momentum
  }
  [[nodiscard]] double length_after(double dt_s) const { return (x + dt_s * v).row(1)(0) - (x + dt_s * v).row(0)(0); }
};

/// Of a limit, over what a step would do beyond it: what impulse_projection.h leaves.
constexpr double kLeft = 1.1e-4;

double longest_strain(const testing::RandomCloth& cloth, const Positions& v, double dt_s) {
  double worst = 0;
  for (const Spring& spring : cloth.springs.springs()) {
    if (spring.kind == SpringKind::kBending) continue;
    const Positions end = cloth.x + dt_s * v;
    worst = std::max(worst, (end.row(spring.b) - end.row(spring.a)).norm() / spring.rest_length_m - 1);
  }
  return worst;
}

}  // namespace

// The second comes behind the first, and has much more to improve: 20 times as fast.
TEST(Strain, LimitsOfTwoClothsAreThoseOfEachAlone) {
  const testing::RandomCloth one = random_cloth(3), other = random_cloth(4);
  const auto count = static_cast<VertexId>(one.x.rows());
  std::vector<Spring> springs = one.springs.springs();
  for (Spring spring : other.springs.springs()) {
    spring.a += count;
    spring.b += count;
    springs.push_back(spring);
  }
  std::vector<double> inverse_mass = one.inverse_mass;
  inverse_mass.insert(inverse_mass.end(), other.inverse_mass.begin(), other.inverse_mass.end());
  Positions x(2 * count, 3), v(2 * count, 3);
  x << one.x, other.x;
  v << one.v, 20 * other.v;
  Positions alone = one.v;
  const std::int64_t impulses = limit_strain(one.springs, one.inverse_mass, one.x, 1e-2, {}, alone);
  EXPECT_GT(impulses, 0);
  EXPECT_GT(limit_strain(SpringSystem(springs, 2 * count), inverse_mass, x, 1e-2, {}, v), impulses);
  EXPECT_EQ(v.topRows(count), alone);
}

TEST(Strain, AFastSpringEndsAtItsLimit) {
  for (const double rate : {5.0, -5.0}) {
    Pair pair(1.05, rate);
    EXPECT_EQ(limit_strain(pair.springs, pair.inverse_mass, pair.x, 0.1, {}, pair.v), 1);
    EXPECT_NEAR(pair.length_after(0.1), rate > 0 ? 1.1 : 0.9, 0.45 * kLeft);
  }
}

TEST(Strain, ASpringBeyondItsLimitDoesNotGetWorseAndIsNotPulledBack) {
  Pair pair(1.3, 2);
  EXPECT_EQ(limit_strain(pair.springs, pair.inverse_mass, pair.x, 0.1, {}, pair.v), 1);
  EXPECT_NEAR(pair.length_after(0.1), 1.3, 0.2 * kLeft);
  Pair returning(1.3, -0.5);
  const Positions before = returning.v;
  EXPECT_EQ(limit_strain(returning.springs, returning.inverse_mass, returning.x, 0.1, {}, returning.v), 0);
  EXPECT_EQ(returning.v, before);
}

TEST(Strain, WithinTheLimitNothingChanges) {
  Pair pair(1.0, 0.9);
  const Positions before = pair.v;
  EXPECT_EQ(limit_strain(pair.springs, pair.inverse_mass, pair.x, 0.1, {}, pair.v), 0);
  EXPECT_EQ(limit_strain_rate(pair.springs, pair.inverse_mass, pair.x, 0.1, {}, pair.v), 0);
  EXPECT_EQ(pair.v, before);
}

TEST(Strain, MotionAcrossIsNotPaidForByPullingIn) {
  // Turning makes the spring too long at the end of the step; an impulse along it would add energy.
  for (const Limiter limiter : {Limiter{limit_strain}, Limiter{limit_strain_rate}}) {
    Pair pair(1.0, 0);
    pair.v << 0, -0.75 * 8, 0, 0, 0.25 * 8, 0;
    const Positions before = pair.v;
    EXPECT_EQ(limiter(pair.springs, pair.inverse_mass, pair.x, 0.1, {}, pair.v), 0);
    EXPECT_EQ(pair.v, before);
  }
}

TEST(Strain, RateIsOfTheCurrentLength) {
  Pair pair(2.0, 5);
  EXPECT_EQ(limit_strain_rate(pair.springs, pair.inverse_mass, pair.x, 0.1, {}, pair.v), 1);
  EXPECT_NEAR(pair.length_after(0.1), 2.2, 1e-15);
}

TEST(Strain, RateLetsASpringComeBackToItsLengthAtRest) {
  for (const double length : {2.0, 0.5}) {
    const double back = length > 1 ? -1 : 1;
    Pair returning(length, back * 4), beyond(length, back * 15);
    EXPECT_EQ(limit_strain_rate(returning.springs, returning.inverse_mass, returning.x, 0.1, {}, returning.v), 0);
    EXPECT_EQ(limit_strain_rate(beyond.springs, beyond.inverse_mass, beyond.x, 0.1, {}, beyond.v), 1);
    EXPECT_NEAR(beyond.length_after(0.1), 1, 1e-15);
  }
}

TEST(Strain, BendingSpringsAndHeldVerticesAreLeftAlone) {
  Pair pair(1.0, 9);
  pair.springs = SpringSystem({Spring{0, 1, SpringKind::kBending, 1.0, 1, 0}}, 2);
  EXPECT_EQ(limit_strain(pair.springs, pair.inverse_mass, pair.x, 0.1, {}, pair.v), 0);
  EXPECT_EQ(limit_strain_rate(pair.springs, pair.inverse_mass, pair.x, 0.1, {}, pair.v), 0);
  Pair held(1.0, 9);
  held.inverse_mass[0] = 0;
  const Vec3 kept = held.v.row(0);
  EXPECT_EQ(limit_strain(held.springs, held.inverse_mass, held.x, 0.1, {}, held.v), 1);
  EXPECT_EQ(Vec3(held.v.row(0)), kept);
  EXPECT_NEAR(held.length_after(0.1), 1.1, 0.8 * kLeft);
}

TEST(Strain, LimitsKeepMomentaAndTakeEnergy) {
  for (const Limiter limiter : {Limiter{limit_strain}, Limiter{limit_strain_rate}}) {
    for (std::uint32_t seed = 0; seed < 20; ++seed) {
      const auto cloth = random_cloth(seed);
      const double dt_s = 0.05;
      const double energy = kinetic_energy(cloth, cloth.v);
      const double scale = std::sqrt(2 * energy * 0.4);  // of momenta: sqrt(2 E M), M about 0.4 kg
      Positions v = cloth.v;
      ASSERT_GT(limiter(cloth.springs, cloth.inverse_mass, cloth.x, dt_s, {}, v), 0);
      EXPECT_LE((linear_momentum(cloth, v) - linear_momentum(cloth, cloth.v)).norm(), 1e-12 * scale);
      EXPECT_LE((angular_momentum(cloth, v) - angular_momentum(cloth, cloth.v)).norm(), 1e-12 * scale);
      EXPECT_LT(kinetic_energy(cloth, v), energy);
    }
  }
}

// The same sweeps written down without passing over any spring; a vertex is held.
TEST(Strain, RateSweepsPassOverOnlySpringsWithNothingToCorrect) {
  for (std::uint32_t seed = 0; seed < 5; ++seed) {
    auto cloth = random_cloth(seed, 12, 0.05);
    cloth.v *= 0.2;
    cloth.inverse_mass[5] = 0;
    const double dt_s = 0.04;
    Positions swept = cloth.v, expected = cloth.v;
    const auto impulses = limit_strain_rate(cloth.springs, cloth.inverse_mass, cloth.x, dt_s, StrainLimits{}, swept);
    for (int sweep = 0; sweep < StrainLimits{}.strain_rate_iterations; ++sweep) {
      for (const Spring& spring : cloth.springs.springs()) {
        const SpringSystem alone({spring}, cloth.springs.vertex_count());
        limit_strain_rate(alone, cloth.inverse_mass, cloth.x, dt_s, {.strain_rate_iterations = 1}, expected);
      }
    }
    EXPECT_GT(impulses, 10);
    EXPECT_LT(impulses, static_cast<std::int64_t>(2 * cloth.springs.springs().size())) << "nothing to pass over";
    EXPECT_LE((swept - expected).norm(), 1e-13 * cloth.v.norm());
  }
}

TEST(Strain, IterationsConverge) {
  const auto cloth = random_cloth(11, 9, 0.05);
  const double dt_s = 0.015;
  ASSERT_GT(longest_strain(cloth, cloth.v, dt_s), 0.2) << "nothing to limit";
  double worst_before = longest_strain(cloth, cloth.v, dt_s);
  for (const std::int32_t iterations : {1, 2, 20}) {
    StrainLimits limits;
    limits.strain_iterations = iterations;
    Positions v = cloth.v;
    limit_strain(cloth.springs, cloth.inverse_mass, cloth.x, dt_s, limits, v);
    const double worst = longest_strain(cloth, v, dt_s);
    EXPECT_LT(worst - 0.1, 0.7 * (worst_before - 0.1)) << iterations;
    worst_before = worst;
  }
  EXPECT_LT(worst_before, 0.1025);
}

}  // namespace selvage
