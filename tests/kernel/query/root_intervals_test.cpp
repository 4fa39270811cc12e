#include "kernel/query/root_intervals.h"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "kernel/arithmetic/rounding.h"
#include "tests/kernel/exact.h"
#include "tests/kernel/random_points.h"

namespace selvage {

using detail::CoplanarityCubic;
using detail::kTicks;
using detail::RootIntervals;
using testing::exact;
using testing::Random;
using testing::Rational;

namespace {

/// lead (t - r0)(t - r1)(t - r2), or with fewer roots, in Bernstein form, rounded to doubles with a bound that says so.
CoplanarityCubic<double> cubic_with_roots(const Rational& lead, const std::vector<Rational>& roots,
                                          double relative_bound) {
  std::vector<Rational> power = {lead};  // power[i] t^i
  for (const Rational& root : roots) {
    std::vector<Rational> next(power.size() + 1);
    for (std::size_t i = 0; i < power.size(); ++i) {
      next[i + 1] += power[i];
      next[i] -= root * power[i];
    }
    power = next;
  }
  power.resize(4);
  const std::array<Rational, 4> bernstein = {power[0], power[0] + power[1] / 3,
                                             power[0] + power[1] * Rational(2, 3) + power[2] / 3,
                                             power[0] + power[1] + power[2] + power[3]};
  CoplanarityCubic<double> cubic;
  double largest = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    cubic.coefficient[i] = bernstein[i].get_d();
    largest = std::max(largest, std::fabs(cubic.coefficient[i]));
  }
  cubic.error_bound = (relative_bound + 2 * detail::kUnitRoundoff + detail::kBlossomError<double>)*largest;
  return cubic;
}

bool contains(const RootIntervals& intervals, const Rational& time) {
  for (int i = 0; i < intervals.count; ++i) {
    const auto& piece = intervals.interval[static_cast<std::size_t>(i)];
    if (exact(detail::time_of(piece.begin)) <= time && time <= exact(detail::time_of(piece.end))) return true;
  }
  return false;
}

double total_width(const RootIntervals& intervals) {
  double width = 0;
  for (int i = 0; i < intervals.count; ++i) {
    const auto& piece = intervals.interval[static_cast<std::size_t>(i)];
    width += detail::time_of(piece.end - piece.begin);
  }
  return width;
}

void expect_sorted_and_disjoint(const RootIntervals& intervals) {
  for (int i = 0; i < intervals.count; ++i) {
    const auto& piece = intervals.interval[static_cast<std::size_t>(i)];
    EXPECT_LT(piece.begin, piece.end);
    EXPECT_LE(piece.end, kTicks);
    EXPECT_TRUE(i == 0 || piece.begin > intervals.interval[static_cast<std::size_t>(i) - 1].end);
  }
  EXPECT_LE(intervals.examined, detail::kMaxIsolation);
}

}  // namespace

TEST(RootIntervals, HoldEveryConstructedRoot) {
  Random random(31);
  int inside = 0;
  for (int i = 0; i < 6000; ++i) {
    std::vector<Rational> roots;
    const int denominator = random.chance(2) ? 1 << random.integer(0, 10) : random.integer(1, 1000);
    for (int count = random.integer(1, 3); count > 0; --count) {
      Rational root(random.integer(-denominator / 4, denominator + denominator / 4), denominator);
      root.canonicalize();
      // Double and triple roots, and near-double ones.
      if (!roots.empty() && random.chance(3)) root = roots.back();
      if (!roots.empty() && random.chance(4)) root = roots.back() + testing::scaled_exactly(1, -random.integer(5, 60));
      roots.push_back(root);
    }
    const Rational lead = exact(random.magnitude(-300, 300));
    const auto cubic = cubic_with_roots(lead, roots, random.chance(2) ? 0 : std::ldexp(1.0, -random.integer(20, 52)));
    const RootIntervals intervals = detail::root_intervals(cubic, detail::kMaxIsolation);
    expect_sorted_and_disjoint(intervals);
    for (const Rational& root : roots) {
      if (root < 0 || root > 1) continue;
      ++inside;
      EXPECT_TRUE(contains(intervals, root)) << root.get_d();
    }
  }
  EXPECT_GT(inside, 6000);
}

TEST(RootIntervals, OfSeparatedSimpleRootsAreNarrow) {
  Random random(32);
  for (int i = 0; i < 2000; ++i) {
    // Roots a tenth apart or more: slope and size of the cubic differ by less than 2^9.
    const double first = 0.05 + 0.2 * std::fabs(random.uniform());
    const std::vector<Rational> roots = {exact(first), exact(first + 0.1 + 0.2 * std::fabs(random.uniform())),
                                         exact(0.75 + 0.2 * std::fabs(random.uniform()))};
    const RootIntervals intervals = detail::root_intervals(cubic_with_roots(1, roots, 0), detail::kMaxIsolation);
    EXPECT_EQ(intervals.count, 3);
    EXPECT_LE(total_width(intervals), 0x1p-38);
    EXPECT_LE(intervals.examined, 40);
  }
}

TEST(RootIntervals, OfDoubleRootsAreAsWideAsTheBoundAllows) {
  for (int i = 1; i < 100; ++i) {
    const Rational root(i, 100);
    const RootIntervals intervals =
        detail::root_intervals(cubic_with_roots(1, {root, root, Rational(2)}, 0), detail::kMaxIsolation);
    EXPECT_TRUE(contains(intervals, root));
    EXPECT_LE(total_width(intervals), 0x1p-20);
  }
}

TEST(RootIntervals, AreAbsentWhereTheCubicKeepsItsSign) {
  Random random(33);
  for (int i = 0; i < 1000; ++i) {
    const std::vector<Rational> roots = {exact(1.25 + std::fabs(random.uniform())),
                                         exact(-0.25 - std::fabs(random.uniform()))};
    EXPECT_EQ(detail::root_intervals(cubic_with_roots(1, roots, 0), detail::kMaxIsolation).count, 0);
  }
}

TEST(RootIntervals, AreEverythingWhereTheCubicVanishes) {
  CoplanarityCubic<double> cubic;
  cubic.error_bound = 0x1p-50;
  for (const double value : {0.0, 0x1p-51}) {
    cubic.coefficient = {value, -value, value, -value};
    const RootIntervals intervals = detail::root_intervals(cubic, detail::kMaxIsolation);
    EXPECT_EQ(intervals.count, 1);
    EXPECT_EQ(intervals.interval[0].begin, 0U);
    EXPECT_EQ(intervals.interval[0].end, kTicks);
  }
}

}  // namespace selvage
