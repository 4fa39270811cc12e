#include "kernel/plane_crossing.h"

#include <gtest/gtest.h>

#include "tests/kernel/exact.h"
#include "tests/kernel/random_points.h"

namespace selvage {

using detail::Double3;
using detail::PairPoints;
using detail::PlaneCrossing;
using testing::exact;
using testing::Random;
using testing::Rational;
using testing::Rational3;

namespace {

constexpr PairKind kKinds[] = {PairKind::kVf, PairKind::kEe};

/// Where the origin's projection lies in the polygon, over the rationals.
struct ExactCrossing {
  Rational alpha, beta;
  Rational3 normal;
  bool inside = false;
  Rational border_squared;  ///< squared distance from the point to the nearest line through an edge

  ExactCrossing(PairKind kind, const PairPoints& x) {
    const std::array<Rational3, 4> d = testing::exact_corners(kind, testing::exact_points(x));
    const Rational3 u = kind == PairKind::kVf ? d[1] - d[0] : d[2] - d[0];
    const Rational3 v = kind == PairKind::kVf ? d[2] - d[0] : d[1] - d[0];
    normal = cross(u, v);
    const Rational n_squared = dot(normal, normal);
    alpha = dot(cross(v, d[0]), normal) / n_squared;
    beta = dot(cross(d[0], u), normal) / n_squared;
    const auto border = [&](const Rational& share, const Rational3& edge, bool first) {
      const Rational squared = testing::squared(share) * n_squared / dot(edge, edge);
      if (first || squared < border_squared) border_squared = squared;
    };
    border(alpha, v, true);
    border(beta, u, false);
    if (kind == PairKind::kVf) {
      border(1 - alpha - beta, v - u, false);
      inside = alpha > 0 && beta > 0 && alpha + beta < 1;
    } else {
      border(1 - alpha, v, false);
      border(1 - beta, u, false);
      inside = alpha > 0 && beta > 0 && alpha < 1 && beta < 1;
    }
  }
};

PairPoints random_pair(Random& random) {
  PairPoints x;
  for (Double3& p : x) p = random.point();
  return x;
}

}  // namespace

TEST(PlaneCrossing, DepthIsBelowTheDistanceToTheBorderAndHasItsSign) {
  Random random(71);
  int inside = 0;
  for (int i = 0; i < 4000; ++i) {
    const PairKind kind = kKinds[i % 2];
    const PairPoints x = random_pair(random);
    const auto motion = detail::make_pair_motion<double>(kind, x, x);
    const PlaneCrossing crossing = detail::plane_crossing(kind, motion.t0);
    const ExactCrossing real(kind, x);
    inside += real.inside;
    if (std::fabs(crossing.depth) < 0x1p-40) continue;
    EXPECT_EQ(crossing.depth > 0, real.inside);
    if (!real.inside) continue;
    const Rational depth = testing::scaled_exactly(exact(crossing.depth * (1 - 0x1p-40)), motion.exponent);
    EXPECT_TRUE(testing::squared(depth) <= real.border_squared);
    // Not idle: a depth is the least weight times a height, and the height over the longest edge is the least one.
    EXPECT_TRUE(testing::squared(depth) * 10000 >= real.border_squared);
  }
  EXPECT_GT(inside, 300);
}

TEST(PlaneCrossing, WeightsAreThoseOfTheNearestPointOfThePlane) {
  Random random(72);
  for (int i = 0; i < 4000; ++i) {
    const PairKind kind = kKinds[i % 2];
    const PairPoints x = random_pair(random);
    const PlaneCrossing crossing = detail::plane_crossing(kind, detail::make_pair_motion<double>(kind, x, x).t0);
    const ExactCrossing real(kind, x);
    const double alpha = real.alpha.get_d(), beta = real.beta.get_d();
    const std::array<double, 4> weights = kind == PairKind::kVf
                                              ? std::array<double, 4>{1, 1 - alpha - beta, alpha, beta}
                                              : std::array<double, 4>{1 - alpha, alpha, 1 - beta, beta};
    // The condition of the polygon, squared: edges over height.
    const double room = 0x1p-48 * (1 + std::fabs(alpha) + std::fabs(beta)) / dot(real.normal, real.normal).get_d();
    for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(crossing.weights[k], weights[k], room * 64);
  }
}

TEST(PlaneCrossing, OutwardSeparatesWhatLiesBeside) {
  Random random(73);
  int beside = 0;
  for (int i = 0; i < 4000; ++i) {
    const PairKind kind = kKinds[i % 2];
    const PairPoints x = random_pair(random);
    const PlaneCrossing crossing = detail::plane_crossing(kind, detail::make_pair_motion<double>(kind, x, x).t0);
    if (!(crossing.depth < -0x1p-30)) continue;
    ++beside;
    const auto corners = testing::exact_corners(kind, testing::exact_points(x));
    for (std::size_t k = 0; k < static_cast<std::size_t>(detail::corner_count(kind)); ++k) {
      EXPECT_TRUE(dot(exact(crossing.outward), corners[k]) > 0);
    }
  }
  EXPECT_GT(beside, 2000);
}

TEST(PlaneCrossing, AFlatPolygonHasNoPlace) {
  const Double3 p = {0.25, 0.5, 0.75}, a = {1, 2, 3}, b = {2, 4, 6}, c = {3, 6, 9};
  for (const PairKind kind : kKinds) {
    const PlaneCrossing crossing =
        detail::plane_crossing(kind, detail::make_pair_motion<double>(kind, {p, a, b, c}, {p, a, b, c}).t0);
    if (kind == PairKind::kVf) {
      EXPECT_FALSE(crossing.depth > 0);
      EXPECT_FALSE(crossing.depth < 0);
    }
  }
}

}  // namespace selvage
