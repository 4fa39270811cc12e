#include "kernel/proximity.h"

#include <limits>

#include <gtest/gtest.h>

#include "tests/kernel/exact_proximity.h"
#include "tests/kernel/pair_kinds.h"
#include "tests/kernel/random_points.h"

namespace selvage {

using detail::Double3;
using testing::exact;
using testing::ExactClosest;
using testing::Random;
using testing::Rational;
using testing::Rational3;
using testing::squared;
using Points = std::array<Vec3, 4>;

namespace {

std::array<Rational3, 4> exact_points(const Points& x) {
  std::array<Rational3, 4> result;
  for (std::size_t i = 0; i < 4; ++i) result[i] = exact(detail::to_double3(x[i]));
  return result;
}

/// x - y for the weights of a proximity, made to sum to one exactly.
Rational3 witness(PairKind kind, const Points& x, const std::array<double, 4>& w) {
  const auto p = exact_points(x);
  const auto share = [&w](std::size_t i, Rational sum) { return Rational(exact(w[i]) / sum); };
  if (kind == PairKind::kVf) {
    const Rational sum = exact(w[1]) + exact(w[2]) + exact(w[3]);
    return p[0] - (share(1, sum) * p[1] + share(2, sum) * p[2] + share(3, sum) * p[3]);
  }
  const Rational first = exact(w[0]) + exact(w[1]), second = exact(w[2]) + exact(w[3]);
  return (share(0, first) * p[0] + share(1, first) * p[1]) - (share(2, second) * p[2] + share(3, second) * p[3]);
}

double largest_difference(PairKind kind, const Points& x) {
  const std::size_t split = kind == PairKind::kVf ? 1 : 2;
  double largest = 0;
  for (std::size_t i = 0; i < split; ++i) {
    for (std::size_t j = split; j < 4; ++j) largest = std::max(largest, (x[i] - x[j]).cwiseAbs().maxCoeff());
  }
  return largest;
}

/// K4 for one configuration. `sharpness`: the bracket's width relative to the largest difference.
void expect_bracket(PairKind kind, const Points& x, double sharpness) {
  const Proximity answer = pair_proximity(kind, x);
  const ExactClosest real(kind, exact_points(x));
  // Booleans, because a failure would print rationals of thousands of digits.
  EXPECT_TRUE(squared(exact(answer.distance_lower)) <= real.distance_squared()) << answer.distance_lower;
  EXPECT_TRUE(squared(exact(answer.distance_upper)) >= real.distance_squared()) << answer.distance_upper;
  EXPECT_LE(answer.distance_lower, answer.distance);
  EXPECT_LE(answer.distance, answer.distance_upper);
  EXPECT_LE(answer.distance_upper - answer.distance_lower,
            sharpness * largest_difference(kind, x) + 2 * std::numeric_limits<double>::denorm_min());
  const Rational3 error = witness(kind, x, answer.weights) - real.point();
  EXPECT_TRUE(dot(error, error) <= squared(exact(answer.point_error_bound))) << answer.point_error_bound;
  const auto& w = answer.weights;
  const double first = kind == PairKind::kVf ? w[0] : w[0] + w[1];
  const double second = kind == PairKind::kVf ? (w[1] + w[2]) + w[3] : w[2] + w[3];
  EXPECT_NEAR(first, 1, 0x1p-50);
  EXPECT_NEAR(second, 1, 0x1p-50);
  for (const double weight : w) EXPECT_TRUE(weight >= 0 && weight <= 1);
  if (answer.distance_upper == 0) {
    EXPECT_EQ(answer.normal, Vec3::Zero());
  } else if (answer.distance_lower > 0) {
    EXPECT_NEAR(answer.normal.norm(), 1, 0x1p-50);
    // The normal is the direction that shows distance_lower, which bounds its angle.
    const Rational3 n = exact(detail::to_double3(answer.normal));
    const Rational along = dot(n, real.point()), least = exact(answer.distance_lower * (1 - 0x1p-48));
    EXPECT_TRUE(along > 0 && squared(along) >= squared(least) * dot(n, n));
  }
}

Points random_points(Random& random) {
  Points x;
  for (Vec3& p : x) p = detail::to_vec3(random.point());
  return x;
}

/// Width of a bracket that nothing has spoilt, relative to the largest difference.
constexpr double kSharp = 0x1p-46;

}  // namespace

TEST(Proximity, BracketsTheExactDistanceOfRandomFeatures) {
  Random random(21);
  for (int i = 0; i < 1500; ++i) expect_bracket(testing::kMeshKinds[i % 2], random_points(random), kSharp);
}

TEST(Proximity, BracketsTheExactDistanceOnTheLattice) {
  Random random(22);
  for (int i = 0; i < 3000; ++i) {
    Points x;
    for (Vec3& p : x) p = Vec3(random.integer(-2, 2), random.integer(-2, 2), random.integer(-2, 2));
    expect_bracket(testing::kMeshKinds[i % 2], x, kSharp);
  }
}

TEST(Proximity, BracketsTheExactDistanceOfNearlyTouchingFeatures) {
  Random random(23);
  for (int i = 0; i < 3000; ++i) {
    Points x;
    for (Vec3& p : x) p = Vec3(random.integer(-3, 3), random.integer(-3, 3), random.integer(-3, 3));
    const double lift = std::ldexp(random.uniform(), -random.integer(10, 60));
    if (i % 2 == 0) {
      x[0] = (x[1] + x[2] + 2 * x[3]) / 4;
      x[0][random.integer(0, 2)] += lift;
    } else {
      x[2] = x[0] + (x[1] - x[0]) / 4 - (x[3] - x[2]);
      x[2][random.integer(0, 2)] += lift;
    }
    expect_bracket(testing::kMeshKinds[i % 2], x, kSharp);
  }
}

TEST(Proximity, BracketsTheExactDistanceOfNeedlesAndSlivers) {
  Random random(24);
  for (int i = 0; i < 3000; ++i) {
    // Squeezed toward a line, then sheared, so that no coordinate axis is special.
    Points x = random_points(random);
    const int squeeze = random.integer(10, 60);
    for (Vec3& p : x) {
      p[1] = std::ldexp(p[1], -squeeze) + 0.5 * p[0];
      p[2] = std::ldexp(p[2], -squeeze) - 0.25 * p[0];
    }
    if (random.chance(2)) x[0] = x[0] + detail::to_vec3(random.point());
    expect_bracket(testing::kMeshKinds[i % 2], x, 0x1p-40);
  }
}

TEST(Proximity, BracketsTheExactDistanceOfDegenerateFeatures) {
  Random random(25);
  for (int i = 0; i < 3000; ++i) {
    Points x = random_points(random);
    for (int copies = random.integer(1, 3); copies > 0; --copies) {
      x[static_cast<std::size_t>(random.integer(0, 3))] = x[static_cast<std::size_t>(random.integer(0, 3))];
    }
    if (random.chance(3)) x[3] = x[1] + 0.5 * (x[2] - x[1]);
    expect_bracket(testing::kMeshKinds[i % 2], x, kSharp);
  }
}

TEST(Proximity, BracketsTheExactDistanceAtEveryScaleAndOffset) {
  Random random(26);
  for (int i = 0; i < 3000; ++i) {
    Points x = random_points(random);
    const int exponent = random.integer(-1074, 990);
    const Vec3 offset = random.chance(2) ? Vec3(std::ldexp(1.0, random.integer(0, 9)) * detail::to_vec3(random.point()))
                                         : Vec3(Vec3::Zero());
    for (Vec3& p : x) {
      for (int axis = 0; axis < 3; ++axis) p[axis] = std::ldexp(p[axis] + offset[axis], exponent);
    }
    expect_bracket(testing::kMeshKinds[i % 2], x, kSharp);
  }
}

TEST(Proximity, BracketsTheExactDistanceOfMixedExponents) {
  Random random(27);
  for (int i = 0; i < 2000; ++i) {
    Points x;
    const int spread = random.integer(1, 1000);
    for (Vec3& p : x) p = detail::to_vec3(random.point(-spread, spread));
    expect_bracket(testing::kMeshKinds[i % 2], x, 0x1p-34);  // features 2^30 times as long as they are apart
  }
}

/// The closest point was within rounding of a short edge and of a long one, of which the direction took no notice; or
/// within rounding of a corner and of a triangle whose normal was noise. Then distance_lower was next to nothing, and
/// the normal anything.
TEST(Proximity, TiesBetweenFeaturesOfVeryDifferentSizesAreBracketed) {
  expect_bracket(PairKind::kEe,
                 {Vec3(-0x1p-116, 0x1p+419, 0x1p-22), Vec3(-0x1p+50, -0x1p-543, 0x1p-86), Vec3(-0x1p-449, 0x1p+536, 0),
                  Vec3(0x1p+312, 0x1p-288, 0x1p+508)},
                 kSharp);
  expect_bracket(PairKind::kVf,
                 {Vec3(0x1.88p+799, -0x1p+437, 0x1p-593), Vec3(-0x1p-252, 0x1p-170, 0x1p-462),
                  Vec3(0x1p+78, -0x1p-634, 0x1.8p+556), Vec3(-0x1p-557, 0x1p-505, -0x1.6p+774)},
                 kSharp);
  expect_bracket(PairKind::kVf,
                 {Vec3(-0x1p-604, 0x1p+711, -0x1p-227), Vec3(0x1p-903, 0x1p-803, 0x1.bp+916),
                  Vec3(0x1.7cp+944, -0x1p+831, -0x1p-477), Vec3(0x1.cp+942, -0x1p-865, 0x1p+393)},
                 kSharp);
  // Widths alone need no rationals, so that many draws cost little.
  Random random(30);
  for (int i = 0; i < 40000; ++i) {
    Points x;
    const int spread = random.integer(1, 1000);
    for (Vec3& p : x) p = detail::to_vec3(random.point(-spread, spread));
    const PairKind kind = testing::kMeshKinds[i % 2];
    const Proximity answer = pair_proximity(kind, x);
    EXPECT_LE(answer.distance_upper - answer.distance_lower, 0x1p-34 * largest_difference(kind, x));
  }
}

TEST(VfProximity, KnownConfigurations) {
  const Points above = {Vec3(0.25, 0.5, 2), Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
  const Proximity face = vf_proximity(above);
  EXPECT_NEAR(face.distance, 2, 0x1p-45);
  EXPECT_NEAR((face.normal - Vec3(0, 0, 1)).norm(), 0, 0x1p-45);
  EXPECT_NEAR(face.weights[1], 0.25, 0x1p-45);
  EXPECT_NEAR(face.weights[2], 0.25, 0x1p-45);
  EXPECT_NEAR(face.weights[3], 0.5, 0x1p-45);

  const Points beside = {Vec3(-3, 0.5, 4), Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
  EXPECT_NEAR(vf_proximity(beside).distance, 5, 0x1p-45);

  const Points touching = {Vec3(1, 0, 0), Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
  const Proximity touch = vf_proximity(touching);
  EXPECT_EQ(touch.distance_upper, 0);
  EXPECT_EQ(touch.weights[2], 1);
}

TEST(EeProximity, KnownConfigurations) {
  const Points crossing = {Vec3(-1, 0, 1), Vec3(1, 0, 1), Vec3(0, -1, 0), Vec3(0, 3, 0)};
  const Proximity cross = ee_proximity(crossing);
  EXPECT_NEAR(cross.distance, 1, 0x1p-45);
  EXPECT_NEAR((cross.normal - Vec3(0, 0, 1)).norm(), 0, 0x1p-45);
  EXPECT_NEAR(cross.weights[2], 0.75, 0x1p-45);

  const Points parallel = {Vec3(0, 0, 0), Vec3(2, 0, 0), Vec3(1, 3, 4), Vec3(5, 3, 4)};
  EXPECT_NEAR(ee_proximity(parallel).distance, 5, 0x1p-45);
}

TEST(Proximity, OfAPairIsTheQueryOfItsKind) {
  const Points x = {Vec3(0, 0, 3), Vec3(1, 0, 0), Vec3(1, 4, 0), Vec3(-3, -1, 0)};
  EXPECT_EQ(pair_proximity(PairKind::kVf, x).distance, 3);
  EXPECT_EQ(pair_proximity(PairKind::kEe, x).distance, ee_proximity(x).distance);
  EXPECT_LT(pair_proximity(PairKind::kEe, x).distance, 3);
  EXPECT_EQ(pair_proximity(PairKind::kSelf, x).distance, self_proximity({x[0], x[1], x[2]}).distance);
  EXPECT_GT(pair_proximity(PairKind::kSelf, x).distance, 3);
}

TEST(Proximity, RelabellingChangesNoBit) {
  Random random(28);
  for (int i = 0; i < 2000; ++i) {
    Points x = random_points(random);
    if (random.chance(4)) x[2] = x[1];
    if (random.chance(4)) x[0] = 0.5 * (x[1] + x[2]);
    const Proximity face = vf_proximity(x);
    constexpr std::size_t kFaceOrders[][3] = {{1, 3, 2}, {2, 1, 3}, {2, 3, 1}, {3, 1, 2}, {3, 2, 1}};
    for (const auto& order : kFaceOrders) {
      const Proximity other = vf_proximity({x[0], x[order[0]], x[order[1]], x[order[2]]});
      EXPECT_EQ(other.distance, face.distance);
      EXPECT_EQ(other.distance_lower, face.distance_lower);
      EXPECT_EQ(other.distance_upper, face.distance_upper);
      EXPECT_EQ(other.point_error_bound, face.point_error_bound);
      EXPECT_EQ(other.normal, face.normal);
      // Coincident corners share their weight in either order.
      if (x[1] != x[2]) {
        for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(other.weights[k + 1], face.weights[order[k]]);
      }
    }
    const Proximity edges = ee_proximity(x);
    const Proximity swapped = ee_proximity({x[3], x[2], x[0], x[1]});
    EXPECT_EQ(swapped.distance, edges.distance);
    EXPECT_EQ(swapped.normal, Vec3(-edges.normal));
    EXPECT_EQ(swapped.weights,
              (std::array<double, 4>{edges.weights[3], edges.weights[2], edges.weights[0], edges.weights[1]}));
  }
}

TEST(Proximity, ScalingByAPowerOfTwoScalesTheAnswer) {
  Random random(29);
  for (int i = 0; i < 2000; ++i) {
    const Points x = random_points(random);
    const PairKind kind = testing::kMeshKinds[i % 2];
    const int exponent = random.integer(-900, 900);
    Points scaled = x;
    for (Vec3& p : scaled) p *= std::ldexp(1.0, exponent);
    const Proximity one = pair_proximity(kind, x), other = pair_proximity(kind, scaled);
    EXPECT_EQ(other.distance, std::ldexp(one.distance, exponent));
    EXPECT_EQ(other.distance_lower, std::ldexp(one.distance_lower, exponent));
    EXPECT_EQ(other.distance_upper, std::ldexp(one.distance_upper, exponent));
    EXPECT_EQ(other.weights, one.weights);
    EXPECT_EQ(other.normal, one.normal);
  }
}

TEST(Proximity, OutsideTheDomainNothingIsClaimed) {
  const double bad[] = {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
                        std::nextafter(kMaxCoordinate, 2 * kMaxCoordinate)};
  for (const double value : bad) {
    for (std::size_t i = 0; i < 4; ++i) {
      Points x = {Vec3(0.25, 0.5, 2), Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
      x[i][1] = value;
      for (const PairKind kind : testing::kMeshKinds) {
        EXPECT_EQ(pair_proximity(kind, x).distance_lower, 0);
        EXPECT_EQ(pair_proximity(kind, x).distance_upper, std::numeric_limits<double>::infinity());
      }
    }
  }
}

}  // namespace selvage
