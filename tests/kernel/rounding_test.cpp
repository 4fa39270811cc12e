// Every bound of kernel/arithmetic/rounding.h against exact rationals, with a record of how much of it is used: a bound
// that is exceeded is wrong, one that is never approached is loose.
#include "kernel/arithmetic/rounding.h"

#include <array>
#include <type_traits>
#include <utility>

#include <gtest/gtest.h>

#include "kernel/arithmetic/power_of_two.h"
#include "kernel/lanes/lane_motion.h"
#include "kernel/query/closest_point.h"
#include "kernel/query/coplanarity.h"
#include "kernel/query/separation.h"
#include "tests/kernel/exact.h"
#include "tests/kernel/pair_kinds.h"
#include "tests/kernel/random_points.h"

namespace selvage {

using detail::Double3;
using detail::DoubleDouble;
using detail::PairMotion;
using detail::PairPoints;
using testing::exact;
using testing::Random;
using testing::Rational;
using testing::Rational3;

namespace {

/// The largest share of a bound that was observed.
class Sharpness {
 public:
  void note(const Rational& error, double bound) {
    EXPECT_TRUE(abs(error) <= exact(bound)) << "bound " << bound;
    if (bound > 0) most_ = std::max(most_, testing::ratio(error, bound));
  }
  void expect_at_least(double share) const {
    ::testing::Test::RecordProperty("sharpness", std::to_string(most_));
    EXPECT_GE(most_, share);
  }

 private:
  double most_ = 0;
};

/// Points of one magnitude or of mixed ones, sometimes small differences at a large offset.
PairPoints random_points(Random& random, int exponent) {
  PairPoints points;
  const Double3 offset = random.chance(2) ? random.point(exponent, exponent + 1) : Double3{};
  const int last = std::max(exponent - random.integer(0, 40), -1073),
            first = std::max(last - random.integer(1, 4), -1074);
  for (Double3& p : points) {
    p = random.point(first, last);
    p = p + offset;
  }
  return points;
}

struct Sample {
  PairKind kind;
  PairPoints x_t0, x_t1;
};

Sample random_sample(Random& random, int first_exponent, int last_exponent) {
  const int exponent = random.integer(first_exponent, last_exponent);
  return {testing::kKinds[random.integer(0, 2)], random_points(random, exponent), random_points(random, exponent)};
}

template <class Real>
Real complement(const Real& t) {
  return Real(1) - t;
}

template <class Real>
Real random_time(Random& random);
template <>
double random_time(Random& random) {
  return detail::time_of(random.bits() >> 12);
}
template <>
DoubleDouble random_time(Random& random) {
  const double offset = static_cast<double>(random.bits() >> 16) * 0x1p-100;
  return detail::two_sum(random_time<double>(random), offset);
}

template <class Real>
void check_supports(int cases, double least_share) {
  Random random(11);
  Sharpness sharpness;
  for (int i = 0; i < cases; ++i) {
    const Sample s = random_sample(random, -1070, 990);
    const auto motion = detail::make_pair_motion<Real>(s.kind, s.x_t0, s.x_t1);
    const Real t = random_time<Real>(random);
    const auto polygon = detail::polygon_at(motion, complement(t), t);
    const Double3 n_leading = random.chance(2) ? random.point() : random.point(-60, 0);
    const detail::Triple<Real> n = {Real(n_leading.x), Real(n_leading.y), Real(n_leading.z)};
    const double bound = detail::support_error(n, motion.extent);
    const auto corners = testing::exact_corners(s.kind, testing::exact_points(s.x_t0, s.x_t1, exact(t)));
    for (std::size_t k = 0; k < static_cast<std::size_t>(detail::corner_count(s.kind)); ++k) {
      const Rational real = testing::scaled_exactly(dot(exact(n), corners[k]), -motion.exponent);
      sharpness.note(exact(detail::dot(n, polygon.corner[k])) - real, bound);
    }
  }
  sharpness.expect_at_least(least_share);
}

/// Bernstein coefficients of 3 det[u, v, r] for vectors that move linearly.
std::array<Rational, 4> exact_cubic(const Rational3& u0, const Rational3& u1, const Rational3& v0, const Rational3& v1,
                                    const Rational3& r0, const Rational3& r1) {
  const auto det = [](const Rational3& a, const Rational3& b, const Rational3& c) { return dot(cross(a, b), c); };
  return {3 * det(u0, v0, r0), det(u1, v0, r0) + det(u0, v1, r0) + det(u0, v0, r1),
          det(u1, v1, r0) + det(u1, v0, r1) + det(u0, v1, r1), 3 * det(u1, v1, r1)};
}

std::array<Rational, 4> exact_cubic(const Sample& s, int exponent) {
  std::array<Rational3, 4> a = testing::exact_points(s.x_t0), b = testing::exact_points(s.x_t1);
  for (auto* x : {&a, &b}) {
    for (Rational3& p : *x) {
      for (Rational& c : p.axis) c = testing::scaled_exactly(c, -exponent);
    }
  }
  if (s.kind == PairKind::kVf) {
    return exact_cubic(a[1] - a[2], b[1] - b[2], a[1] - a[3], b[1] - b[3], a[0] - a[1], b[0] - b[1]);
  }
  return exact_cubic(a[1] - a[0], b[1] - b[0], a[2] - a[3], b[2] - b[3], a[0] - a[2], b[0] - b[2]);
}

/// The blossom of a cubic: its Bernstein coefficients over [t0, t1].
std::array<Rational, 4> restricted(const std::array<Rational, 4>& c, const Rational& t0, const Rational& t1) {
  std::array<Rational, 4> result;
  for (std::size_t k = 0; k < 4; ++k) {
    std::array<Rational, 4> level = c;
    for (std::size_t step = 0; step < 3; ++step) {
      const Rational t = step < k ? t1 : t0;
      for (std::size_t i = 0; i < 3 - step; ++i) level[i] = (1 - t) * level[i] + t * level[i + 1];
    }
    result[k] = level[0];
  }
  return result;
}

template <class Real>
void check_cubics(int cases, double least_share) {
  Random random(12);
  Sharpness sharpness;
  for (int i = 0; i < cases; ++i) {
    Sample s = random_sample(random, -1070, 990);
    if (s.kind == PairKind::kSelf) s.kind = PairKind::kVf;
    const auto motion = detail::make_pair_motion<Real>(s.kind, s.x_t0, s.x_t1);
    const auto cubic = detail::coplanarity_cubic(motion);
    const auto real = exact_cubic(s, motion.exponent);
    for (std::size_t k = 0; k < 4; ++k) sharpness.note(exact(cubic.coefficient[k]) - real[k], cubic.error_bound);
    const detail::Tick first = random.bits() >> 12,
                       last = first + ((random.bits() >> 12) % (detail::kTicks - first + 1));
    const auto local = detail::local_coefficients(cubic, {first, last});
    const auto real_local = restricted(real, exact(detail::time_of(first)), exact(detail::time_of(last)));
    for (std::size_t k = 0; k < 4; ++k) sharpness.note(exact(local[k]) - real_local[k], cubic.error_bound);
  }
  sharpness.expect_at_least(least_share);
}

/// Corner and edge of a vertex-face pair, exactly, at t.
std::pair<Rational3, Rational3> exact_corner_and_edge(const Sample& s, const Rational& t, int exponent) {
  auto x = testing::exact_points(s.x_t0, s.x_t1, t);
  for (Rational3& p : x) {
    for (Rational& c : p.axis) c = testing::scaled_exactly(c, -exponent);
  }
  return {x[0] - x[1], x[1] - x[2]};
}

template <class Real>
void check_windings(int cases, double least_share) {
  Random random(16);
  Sharpness sharpness;
  for (int i = 0; i < cases; ++i) {
    Sample s = random_sample(random, -1070, 990);
    s.kind = PairKind::kVf;
    const auto motion = detail::make_pair_motion<Real>(s.kind, s.x_t0, s.x_t1);
    const Real t0 = random_time<Real>(random), t1 = random_time<Real>(random);
    const auto begin = detail::polygon_at(motion, complement(t0), t0),
               end = detail::polygon_at(motion, complement(t1), t1);
    const auto computed = detail::cross_motion(begin.corner[0], end.corner[0], begin.edge_u, end.edge_u);
    const auto [d0, e0] = exact_corner_and_edge(s, exact(t0), motion.exponent);
    const auto [d1, e1] = exact_corner_and_edge(s, exact(t1), motion.exponent);
    const Rational3 first = cross(d0, e0), middle_doubled = cross(d0, e1) + cross(d1, e0), last = cross(d1, e1);
    const Double3 bound = detail::winding_error(motion);
    const auto note = [&sharpness](const Double3& value, const Rational3& real, const Double3& limit) {
      // The double nearest to a double-double value carries one rounding of its own.
      const auto one = [&sharpness](double v, const Rational& r, double l) {
        sharpness.note(exact(v) - r, std::is_same_v<Real, double> ? l : l + std::fabs(v) * 0x1p-53);
      };
      one(value.x, real[0], limit.x);
      one(value.y, real[1], limit.y);
      one(value.z, real[2], limit.z);
    };
    note(computed.first, first, bound);
    note(computed.middle_doubled, middle_doubled, detail::scaled(2.0, bound));
    note(computed.last, last, bound);
  }
  sharpness.expect_at_least(least_share);
}

// The bounds that kernel/proofs/*.gappa prove, in the terms of these files.
static_assert(detail::kPointRoundings == 3);
static_assert(detail::kSupportError<double> == 25 * 0x1p-55 && detail::kSupportError<DoubleDouble> == 99 * 0x1p-108);
static_assert(detail::kWindingError<double> == 37 * 0x1p-55 && detail::kWindingError<DoubleDouble> == 139 * 0x1p-108);
static_assert(detail::kDeterminantError<double> == 41 * 0x1p-55 &&
              detail::kDeterminantError<DoubleDouble> == 139 * 0x1p-108);
static_assert(detail::kBlossomError<double> == 25 * 0x1p-55 && detail::kBlossomError<DoubleDouble> == 127 * 0x1p-108);
static_assert(detail::kWitnessError == 25 * 0x1p-55 && detail::kBlendError == 13 * 0x1p-55);
static_assert(detail::kNormError == 11 * 0x1p-55);
static_assert(detail::kQuotientError == 8 * 0x1p-53 && detail::kWitnessQuotientError == 32 * 0x1p-53);
static_assert(detail::kNearError == 21 * 0x1p-25F);
static_assert(detail::RoundingOf<DoubleDouble>::kProduct == 7 * 0x1p-106);
static_assert(detail::kUnderflowError > 0x1p-1058 && detail::kNearSlack > 0x1p-147F);

}  // namespace

TEST(WindingError, HoldsInDoublesAtEveryMagnitude) { check_windings<double>(4000, 0.2); }
TEST(WindingError, HoldsInDoubleDoublesAtEveryMagnitude) { check_windings<DoubleDouble>(2000, 0.5); }
TEST(SupportError, HoldsInDoublesAtEveryMagnitude) { check_supports<double>(8000, 0.3); }
TEST(SupportError, HoldsInDoubleDoublesAtEveryMagnitude) { check_supports<DoubleDouble>(4000, 0.02); }
TEST(DeterminantError, HoldsInDoublesAtEveryMagnitude) { check_cubics<double>(6000, 0.05); }
TEST(DeterminantError, HoldsInDoubleDoublesAtEveryMagnitude) { check_cubics<DoubleDouble>(3000, 0.001); }

/// g++ 12 with -O2 hands the doubles back, as they were, in `back`, unless it is told not to (SelvageToolchain.cmake).
[[gnu::noinline]] void to_floats_and_back(const std::array<double, 2>& x, std::array<float, 2>& floats,
                                          std::array<double, 2>& back) {
  floats[0] = static_cast<float>(x[0]);
  floats[1] = static_cast<float>(x[1]);
  back[0] = static_cast<double>(floats[0]);
  back[1] = static_cast<double>(floats[1]);
}

TEST(Compiler, RoundsDoublesThatBecomeFloatsSideBySide) {
  std::array<float, 2> floats{};
  std::array<double, 2> back{};
  to_floats_and_back({0x1.0000001p0, 0x1.fffffffp-2}, floats, back);
  EXPECT_EQ(floats, (std::array<float, 2>{0x1p0F, 0x1p-1F}));
  EXPECT_EQ(back, (std::array<double, 2>{0x1p0, 0x1p-1}));
}

/// The rows that LaneMotion makes of a mesh of one magnitude or of mixed ones, near its origin or far from it.
TEST(NearError, HoldsAtEveryMagnitude) {
  Random random(17);
  Sharpness sharpness;
  for (int i = 0; i < 4000; ++i) {
    const Sample s = random_sample(random, -1070, 990);
    Positions V_t0(4, 3), V_t1(4, 3);
    for (Eigen::Index v = 0; v < 4; ++v) {
      V_t0.row(v) = to_vec3(s.x_t0[static_cast<std::size_t>(v)]);
      V_t1.row(v) = to_vec3(s.x_t1[static_cast<std::size_t>(v)]);
    }
    const detail::LaneMotion motion(V_t0, V_t1);
    ASSERT_TRUE(motion.is_valid());
    const Double3 direction = random.chance(2) ? random.point() : random.point(-60, 0);
    const std::array<float, 3> n = {static_cast<float>(direction.x), static_cast<float>(direction.y),
                                    static_cast<float>(direction.z)};
    const auto project = [&n](const float* x) { return (n[0] * x[0] + n[1] * x[1]) + n[2] * x[2]; };
    const auto p = static_cast<std::size_t>(random.integer(0, 3)), q = static_cast<std::size_t>(random.integer(0, 3));
    for (const std::size_t end : {0U, 1U}) {
      const PairPoints& x = end == 0 ? s.x_t0 : s.x_t1;
      const float* const rows = motion.near_rows.front().data() + 4 * end;
      const float computed = project(rows + 8 * p) - project(rows + 8 * q);
      const Rational3 exact_n =
          exact(Double3{static_cast<double>(n[0]), static_cast<double>(n[1]), static_cast<double>(n[2])});
      const Rational real = testing::scaled_exactly(dot(exact_n, exact(x[p]) - exact(x[q])), -motion.near_exponent);
      const float size = (std::fabs(n[0]) + std::fabs(n[1])) + std::fabs(n[2]);
      const auto bound = static_cast<double>(detail::kNearError * size + detail::kNearSlack);
      sharpness.note(exact(static_cast<double>(computed)) - real, bound);
    }
  }
  sharpness.expect_at_least(0.1);
}

TEST(SupportError, ScalesWithTheExtentAndTheDirection) {
  const Double3 n = {0.5, -0.25, 1}, extent = {0.75, 0.5, 0.125};
  const double bound = detail::support_error(n, extent);
  EXPECT_EQ(detail::support_error(detail::scaled(2.0, n), extent), 2 * bound);
  EXPECT_EQ(detail::support_error(n, detail::scaled(0.5, extent)), 0.5 * bound);
}

TEST(NormError, HoldsAtEveryMagnitude) {
  Random random(13);
  Sharpness sharpness;
  for (int i = 0; i < 20000; ++i) {
    const int exponent = random.integer(-1000, 900);
    const Double3 v = random.chance(4) ? random.point(exponent, exponent + 80) : random.point(exponent, exponent + 2);
    const Rational squared = dot(exact(v), exact(v));
    const Rational computed = exact(detail::norm(v)), bound = exact(detail::kNormError);
    // |computed - real| <= bound real, squared: exact without a root.
    EXPECT_TRUE(testing::squared(computed) <= squared * testing::squared(1 + bound));
    EXPECT_TRUE(testing::squared(computed) >= squared * testing::squared(1 - bound));
    sharpness.note(testing::squared(computed) / squared - 1, 2.01 * detail::kNormError);
  }
  sharpness.expect_at_least(0.3);
}

TEST(DoubleDouble, SumAndProductKeepTheirBounds) {
  Random random(14);
  Sharpness sums, products;
  for (int i = 0; i < 40000; ++i) {
    const auto number = [&random] {
      const double high = random.magnitude(-30, 1);
      return detail::two_sum(high, high * random.uniform() * std::ldexp(1.0, -random.integer(53, 70)));
    };
    const DoubleDouble a = number(), b = number();
    const Rational sum = exact(a) + exact(b), product = exact(a) * exact(b);
    sums.note(exact(a + b) - sum, std::fabs(sum.get_d()) * (3.01 * 0x1p-106) + 0x1p-1000);
    products.note(exact(a * b) - product, std::fabs(product.get_d()) * (7.01 * 0x1p-106) + 0x1p-1000);
  }
  sums.expect_at_least(0.3);
  products.expect_at_least(0.3);
}

TEST(ScalingByPowersOfTwo, RoundsTheStatedWay) {
  Random random(15);
  for (int i = 0; i < 20000; ++i) {
    const double value = std::fabs(random.magnitude(-1074, 1000));
    const int e = random.integer(-1073, 1000);
    const Rational real = testing::scaled_exactly(exact(value), e);
    if (real >= testing::scaled_exactly(1, 1023)) continue;
    EXPECT_TRUE(exact(detail::times_power_upper(value, e)) >= real);
    EXPECT_TRUE(exact(detail::times_power_lower(value, e)) <= real);
    EXPECT_TRUE(abs(exact(detail::times_power(value, e)) - real) <= testing::scaled_exactly(1, -1074));
    if (real >= testing::scaled_exactly(1, -1022)) {
      EXPECT_EQ(exact(detail::times_power(value, e)), real);
    }
    const double unit = detail::times_power(value, -detail::exponent_of(value));
    EXPECT_TRUE(unit >= 0.5 && unit < 1);
  }
  // A tie between the largest subnormal number and the least normal one, to which it rounds.
  const double value = 1 - 0x1p-53;
  const Rational real = testing::scaled_exactly(exact(value), -1022);
  EXPECT_TRUE(exact(detail::times_power_lower(value, -1022)) <= real);
  EXPECT_TRUE(exact(detail::times_power_upper(value, -1022)) >= real);
}

}  // namespace selvage
