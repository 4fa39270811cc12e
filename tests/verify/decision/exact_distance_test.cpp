#include "verify/decision/exact_distance.h"

#include <array>
#include <optional>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "tests/verify/overlap_reference.h"
#include "verify/filter/distance_filter.h"
#include "verify/filter/near_filter.h"

namespace selvage::verify {
namespace {

using reference::Rational;
using reference::Vector;
using reference::operator-;
using reference::operator+;
using reference::operator*;

/// Solves the square system by elimination; nothing where it is singular.
std::optional<std::vector<Rational>> solve(std::vector<std::vector<Rational>> m, std::vector<Rational> right) {
  const std::size_t n = right.size();
  for (std::size_t i = 0; i < n; ++i) {
    std::size_t pivot = i;
    while (pivot < n && m[pivot][i] == 0) ++pivot;
    if (pivot == n) return std::nullopt;
    std::swap(m[i], m[pivot]);
    std::swap(right[i], right[pivot]);
    for (std::size_t j = 0; j < n; ++j) {
      if (j == i || m[j][i] == 0) continue;
      const Rational factor = m[j][i] / m[i][i];
      for (std::size_t k = 0; k < n; ++k) m[j][k] -= factor * m[i][k];
      right[j] -= factor * right[i];
    }
  }
  for (std::size_t i = 0; i < n; ++i) right[i] /= m[i][i];
  return right;
}

/// Squared distance of two affine hulls, where its feet lie in the convex hulls of the points.
std::optional<Rational> feet_inside(const std::vector<Vector>& p, const std::vector<Vector>& q) {
  std::vector<Vector> directions;
  for (std::size_t i = 1; i < p.size(); ++i) directions.push_back(p[i] - p[0]);
  for (std::size_t j = 1; j < q.size(); ++j) directions.push_back(q[0] - q[j]);
  const Vector offset = p[0] - q[0];
  std::vector<std::vector<Rational>> gram(directions.size(), std::vector<Rational>(directions.size()));
  std::vector<Rational> right(directions.size());
  for (std::size_t i = 0; i < directions.size(); ++i) {
    for (std::size_t j = 0; j < directions.size(); ++j) gram[i][j] = reference::dot(directions[i], directions[j]);
    right[i] = -reference::dot(directions[i], offset);
  }
  const auto weights = solve(gram, right);
  if (!weights) return std::nullopt;
  Vector gap = offset;
  Rational p_rest = 1, q_rest = 1;
  for (std::size_t i = 0; i < directions.size(); ++i) {
    if ((*weights)[i] < 0) return std::nullopt;
    (i < p.size() - 1 ? p_rest : q_rest) -= (*weights)[i];
    gap = gap + (*weights)[i] * directions[i];
  }
  if (p_rest < 0 || q_rest < 0) return std::nullopt;
  return reference::dot(gap, gap);
}

/// By trying all faces of both simplices: the nearest points lie inside some pair of faces.
Rational distance_squared(const std::vector<Vector>& p, const std::vector<Vector>& q) {
  const auto subset = [](const std::vector<Vector>& points, unsigned mask) {
    std::vector<Vector> chosen;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if ((mask >> i & 1U) != 0) chosen.push_back(points[i]);
    }
    return chosen;
  };
  std::optional<Rational> least;
  for (unsigned s = 1; s < 1U << p.size(); ++s) {
    for (unsigned t = 1; t < 1U << q.size(); ++t) {
      const auto squared = feet_inside(subset(p, s), subset(q, t));
      if (squared && (!least || *squared < *least)) least = squared;
    }
  }
  return *least;
}

int refer(const std::array<Vector, 4>& x, bool is_vf, double d) {
  const std::size_t split = is_vf ? 1 : 2;
  const Rational squared = distance_squared({x.begin(), x.begin() + split}, {x.begin() + split, x.end()});
  return cmp(squared, Rational(Rational(d) * Rational(d)));
}

std::array<Vector, 4> exact(const std::array<Point, 4>& x) {
  return {reference::exact(x[0]), reference::exact(x[1]), reference::exact(x[2]), reference::exact(x[3])};
}

std::array<Point, 4> draw(std::mt19937& random, int range) {
  std::uniform_int_distribution<int> lattice(-range, range);
  std::array<Point, 4> x;
  for (Point& p : x) p = {double(lattice(random)), double(lattice(random)), double(lattice(random))};
  if (random() % 3 == 0) x[3] = x[random() % 3];  // zero-area, zero-length, or touching
  if (random() % 3 == 0) {
    for (std::size_t k = 0; k < 3; ++k) x[3][k] = x[2][k] + (x[1][k] - x[0][k]);  // parallel edges
  }
  if (random() % 3 == 0) {
    for (Point& p : x) p[2] = 0;
  }
  return x;
}

constexpr double kDistances[] = {0, 0.5, 1, 1.5, 2, 3, 5};

}  // namespace

TEST(ExactDistance, AgreesWithAllFacesOnSmallIntegers) {
  std::mt19937 random(5);
  std::array<int, 3> seen{};
  for (int i = 0; i < 4000; ++i) {
    const std::array<Point, 4> x = draw(random, 1 + i % 4);
    const double d = kDistances[random() % std::size(kDistances)];
    const int vf = compare_vf_distance(x, d), ee = compare_ee_distance(x, d);
    ASSERT_EQ(vf, refer(exact(x), true, d)) << i << " d = " << d;
    ASSERT_EQ(ee, refer(exact(x), false, d)) << i << " d = " << d;
    ++seen[static_cast<std::size_t>(vf + 1)];
    ++seen[static_cast<std::size_t>(ee + 1)];
  }
  for (const int count : seen) EXPECT_GE(count, 300);  // closer, equal, farther
}

TEST(ExactDistance, FollowsExactScaling) {
  std::mt19937 random(6);
  for (int i = 0; i < 500; ++i) {
    const std::array<Point, 4> x = draw(random, 2);
    const double d = kDistances[random() % std::size(kDistances)];
    for (const double scale : {0x1p-1073, 0x1p-540, 0x1p+300, 0x1p+1018}) {
      std::array<Point, 4> y = x;
      for (Point& p : y) {
        for (double& coordinate : p) coordinate *= scale;
      }
      ASSERT_EQ(compare_vf_distance(y, d * scale), compare_vf_distance(x, d)) << scale;
      ASSERT_EQ(compare_ee_distance(y, d * scale), compare_ee_distance(x, d)) << scale;
    }
  }
}

TEST(ExactDistance, WithinAtATimeAgreesWithRationalPositions) {
  std::mt19937 random(8);
  int within = 0;
  for (int i = 0; i < 3000; ++i) {
    const std::array<Point, 4> x_t0 = draw(random, 2), x_t1 = draw(random, 2);
    const double times[] = {0, 1, 0.5, 0.375, 0.1, 0x1p-1074, 1 - 0x1p-53};
    const double t = times[random() % std::size(times)], d = kDistances[random() % std::size(kDistances)];
    std::array<Vector, 4> at_t;
    for (std::size_t j = 0; j < 4; ++j) {
      const Vector from = reference::exact(x_t0[j]);
      at_t[j] = from + Rational(t) * (reference::exact(x_t1[j]) - from);
    }
    const bool vf = vf_within_at(x_t0, x_t1, t, d), ee = ee_within_at(x_t0, x_t1, t, d);
    ASSERT_EQ(vf, refer(at_t, true, d) <= 0) << i << " t = " << t << " d = " << d;
    ASSERT_EQ(ee, refer(at_t, false, d) <= 0) << i << " t = " << t << " d = " << d;
    within += (vf ? 1 : 0) + (ee ? 1 : 0);
  }
  EXPECT_GE(within, 1000);
  EXPECT_LE(within, 5000);
}

TEST(ExactDistance, RefusesWhatIsNoDistanceOrTime) {
  const std::array<Point, 4> x{};
  EXPECT_THROW(static_cast<void>(compare_vf_distance(x, -1)), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(compare_ee_distance(x, std::nan(""))), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(vf_within_at(x, x, 1.5, 1)), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(ee_within_at(x, x, std::nan(""), 1)), std::invalid_argument);
}

using Triage = bool (*)(const std::array<Point, 4>&, double);

/// Asserts that what the filter proves is true, and that it proves nine tenths of what is, at ordinary sizes. `sign` is
/// the one that compare_vf_distance has where the filter should prove.
void expect_sound_and_sharp(Triage of_vf, Triage of_ee, int sign) {
  std::mt19937 random(9);
  std::uniform_real_distribution<double> uniform(-1, 1);
  int provable = 0, proved = 0;
  for (int i = 0; i < 6000; ++i) {
    std::array<Point, 4> x = draw(random, 2);
    const double scales[] = {0x1p-540, 1, 0x1p+510};
    const double scale = scales[i % 3];
    for (Point& p : x) {
      for (double& coordinate : p) coordinate = (coordinate / 3 + (i % 2 == 0 ? uniform(random) : 0)) * scale;
    }
    const double d = kDistances[random() % std::size(kDistances)] * scale / 3;
    for (const bool is_vf : {true, false}) {
      const int exact_sign = is_vf ? compare_vf_distance(x, d) : compare_ee_distance(x, d);
      const bool proof = is_vf ? of_vf(x, d) : of_ee(x, d);
      ASSERT_FALSE(proof && exact_sign != sign && exact_sign != 0) << i;
      ASSERT_FALSE(proof && sign > 0 && exact_sign == 0) << i;  // "within d" is closed, "farther" is not
      if (scale == 1) provable += exact_sign == sign ? 1 : 0, proved += proof ? 1 : 0;
    }
  }
  EXPECT_GE(proved * 100, provable * 90);
}

TEST(DistanceFilter, NeverContradictsAndUsuallyDecides) {
  expect_sound_and_sharp(triage_vf_farther, triage_ee_farther, 1);
}

TEST(NearFilter, NeverContradictsAndUsuallyDecides) { expect_sound_and_sharp(triage_vf_nearer, triage_ee_nearer, -1); }

}  // namespace selvage::verify
