#include "sim/springs/impulse_projection.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "tests/sim/random_cloth.h"
#include "tests/vector_units.h"

namespace selvage {

using namespace sim;
using testing::random_cloth;

namespace {

using Start = ImpulseProjection::Start;

/// A crumpled sheet in motion, one vertex of it held; its springs may not grow longer by more than their bounds.
struct Bounded {
  testing::RandomCloth cloth;
  std::vector<double> bounds_m_s;

  explicit Bounded(std::uint32_t seed) : cloth(random_cloth(seed)) {
    cloth.inverse_mass[40] = 0;
    cloth.v.row(40).setZero();
    for (std::size_t i = 0; i < cloth.springs.springs().size(); ++i) bounds_m_s.push_back(0.05 * double(i % 3));
  }
  [[nodiscard]] std::vector<BoundedPair> pairs(double unit = 1) const {
    std::vector<BoundedPair> result;
    for (std::size_t i = 0; i < bounds_m_s.size(); ++i) {
      const Spring& spring = cloth.springs.springs()[i];
      const Vec3 towards_b = (cloth.x.row(spring.b) - cloth.x.row(spring.a)).normalized();
      const double excess = (cloth.v.row(spring.b) - cloth.v.row(spring.a)).dot(towards_b) - bounds_m_s[i];
      result.push_back({spring.a, spring.b, cloth.inverse_mass[static_cast<std::size_t>(spring.a)],
                        cloth.inverse_mass[static_cast<std::size_t>(spring.b)], towards_b, unit * excess});
    }
    return result;
  }
  [[nodiscard]] Positions v_after(const std::vector<BoundedPair>& pairs) const {
    Positions v = cloth.v;
    for (const BoundedPair& pair : pairs) {
      v.row(pair.a) += pair.inverse_mass_a * pair.impulse_n_s * pair.direction.transpose();
      v.row(pair.b) -= pair.inverse_mass_b * pair.impulse_n_s * pair.direction.transpose();
    }
    return v;
  }
  [[nodiscard]] double kinetic_j(const Positions& v) const {
    double sum = 0;
    for (Eigen::Index i = 0; i < v.rows(); ++i) {
      const double w = cloth.inverse_mass[static_cast<std::size_t>(i)];
      if (w > 0) sum += v.row(i).squaredNorm() / w / 2;
    }
    return sum;
  }
  /// What is minimised: of the motion, and the impulses times their bounds.
  [[nodiscard]] double cost_j(const std::vector<BoundedPair>& pairs) const {
    double sum = kinetic_j(v_after(pairs));
    for (std::size_t i = 0; i < pairs.size(); ++i) sum += pairs[i].impulse_n_s * bounds_m_s[i];
    return sum;
  }
  [[nodiscard]] ImpulseProjection projection() const { return ImpulseProjection(cloth.springs.vertex_count()); }
};

}  // namespace

TEST(ImpulseProjection, ConvergesToBoundsThatAreKeptAndImpulsesThatAreNeeded) {
  for (std::uint32_t seed = 0; seed < 10; ++seed) {
    const Bounded bounded(seed);
    auto pairs = bounded.pairs();
    double without = 0;
    for (const BoundedPair& pair : pairs) without = std::max(without, pair.excess_m_s);
    ASSERT_GT(without, 1);
    bounded.projection().solve(pairs, Start::kGuess, 1000);
    const Positions v = bounded.v_after(pairs);
    int acting = 0;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const BoundedPair& pair = pairs[i];
      const double excess = (v.row(pair.b) - v.row(pair.a)).dot(pair.direction) - bounded.bounds_m_s[i];
      EXPECT_GE(pair.impulse_n_s, 0);
      EXPECT_EQ(pair.change_n_s, pair.impulse_n_s);
      EXPECT_LT(excess, 0.1 * without);
      if (pair.impulse_n_s > 0) {
        ++acting;
        EXPECT_LT(std::abs(excess), 0.1 * without) << "an impulse that nothing asks for";
      }
    }
    EXPECT_GT(acting, 50);
    EXPECT_LT(acting, static_cast<int>(pairs.size()));
  }
}

TEST(ImpulseProjection, TakesEnergyInEveryIteration) {
  for (std::uint32_t seed = 0; seed < 10; ++seed) {
    const Bounded bounded(seed);
    double last_j = bounded.kinetic_j(bounded.cloth.v);
    for (std::int32_t iterations = 1; iterations < 30; ++iterations) {
      auto pairs = bounded.pairs();
      bounded.projection().solve(pairs, Start::kGuess, iterations);
      const double now_j = bounded.cost_j(pairs);
      EXPECT_LE(now_j, last_j * (1 + 1e-12)) << iterations;
      last_j = now_j;
    }
    EXPECT_LT(last_j, 0.8 * bounded.kinetic_j(bounded.cloth.v));
  }
}

TEST(ImpulseProjection, ABadGuessAddsNoEnergyAndAGoodOneIsTaken) {
  const Bounded bounded(3);
  for (const std::int32_t iterations : {0, 1, 3}) {
    auto bad = bounded.pairs();
    for (std::size_t i = 0; i < bad.size(); ++i) bad[i].impulse_n_s = i % 2 == 0 ? 10 : 0.01;
    bounded.projection().solve(bad, Start::kGuess, iterations);
    EXPECT_LE(bounded.cost_j(bad), bounded.kinetic_j(bounded.cloth.v)) << iterations;
  }
  auto good = bounded.pairs();
  bounded.projection().solve(good, Start::kGuess, 1000);
  const double best_j = bounded.cost_j(good);
  bounded.projection().solve(good, Start::kGuess, 0);
  EXPECT_NEAR(bounded.cost_j(good), best_j, 1e-3 * best_j);
}

TEST(ImpulseProjection, GoesOnFromImpulsesThatAct) {
  const Bounded bounded(5);
  ImpulseProjection projection = bounded.projection();
  auto pairs = bounded.pairs();
  projection.solve(pairs, Start::kGuess, 3);
  const double first_j = bounded.cost_j(pairs);
  const Positions v = bounded.v_after(pairs);
  auto acting = pairs;
  for (std::size_t i = 0; i < acting.size(); ++i) {
    const BoundedPair& pair = acting[i];
    acting[i].excess_m_s = (v.row(pair.b) - v.row(pair.a)).dot(pair.direction) - bounded.bounds_m_s[i];
  }
  projection.solve(acting, Start::kActing, 100);
  EXPECT_LT(bounded.cost_j(acting), 0.99 * first_j);
  for (std::size_t i = 0; i < acting.size(); ++i) {
    EXPECT_NEAR(acting[i].change_n_s, acting[i].impulse_n_s - pairs[i].impulse_n_s, 1e-15);
  }
}

TEST(ImpulseProjection, AnyUnitOfSpeedFindsTheSame) {
  const Bounded bounded(7);
  auto pairs = bounded.pairs();
  bounded.projection().solve(pairs, Start::kGuess, 20);
  for (const double unit : {0x1p-900, 0x1p900}) {
    auto scaled = bounded.pairs(unit);
    bounded.projection().solve(scaled, Start::kGuess, 20);
    for (std::size_t i = 0; i < pairs.size(); ++i) EXPECT_EQ(scaled[i].impulse_n_s, unit * pairs[i].impulse_n_s);
  }
}

TEST(ImpulseProjection, SameBitsForAnyVectorUnitAndWhateverWasSolvedBefore) {
  const Bounded bounded(9);
  const auto solve = [&](std::size_t count, ImpulseProjection& projection) {
    auto pairs = bounded.pairs();
    pairs.resize(std::min(count, pairs.size()));
    projection.solve(pairs, Start::kGuess, 2);
    for (BoundedPair& pair : pairs) pair.excess_m_s *= 0.5;
    projection.solve(pairs, Start::kActing, 20);
    std::vector<double> impulses_n_s;
    for (const BoundedPair& pair : pairs) impulses_n_s.push_back(pair.impulse_n_s);
    return impulses_n_s;
  };
  for (const std::size_t count : {1U, 7U, 8U, 9U, 10'000U}) {
    ImpulseProjection fresh = bounded.projection(), used = bounded.projection();
    (void)solve(10'000, used);
    const std::vector<double> reference = solve(count, fresh);
    EXPECT_GT(*std::ranges::max_element(reference), 0) << count;
    testing::on_every_vector_unit([&](const char* unit) { EXPECT_EQ(solve(count, used), reference) << unit << count; });
  }
}

TEST(ImpulseProjection, WhatIsNotFiniteChangesNothing) {
  const Bounded bounded(1);
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (const double bad : {kInfinity, -kInfinity, std::numeric_limits<double>::quiet_NaN()}) {
    auto pairs = bounded.pairs();
    pairs[3].impulse_n_s = 1;
    pairs[9].excess_m_s = bad;
    bounded.projection().solve(pairs, Start::kGuess, 20);
    for (const BoundedPair& pair : pairs) EXPECT_EQ(pair.impulse_n_s, 0);
  }
}

}  // namespace selvage
