// What plain doubles say of a passage through the plane, against the exact checker.
#include "kernel/query/plane_passage.h"

#include <gtest/gtest.h>

#include "kernel/arithmetic/power_of_two.h"
#include "tests/kernel/exact.h"
#include "tests/kernel/pair_kinds.h"
#include "tests/kernel/random_points.h"
#include "verify/decision/exact_distance.h"
#include "verify/decision/exact_motion.h"

namespace selvage {

using detail::PairPoints;
using detail::Passage;
using detail::PlanePassage;
using testing::exact;
using testing::Random;
using testing::Rational;
using testing::Rational3;

namespace {

struct Query {
  PairKind kind = PairKind::kVf;
  PairPoints x_t0, x_t1;

  [[nodiscard]] PlanePassage passage() const {
    return plane_passage(detail::make_pair_motion<double>(kind, x_t0, x_t1));
  }
};

std::array<verify::Point, 4> for_checker(const PairPoints& x) {
  std::array<verify::Point, 4> points;
  for (std::size_t k = 0; k < 4; ++k) points[k] = {x[k].x, x[k].y, x[k].z};
  return points;
}

/// Points of unit size that move by about as much, or by a fraction of it around a meeting of the features.
Query random_query(Random& random, PairKind kind) {
  Query query{kind, {}, {}};
  const bool meet = random.chance(2);
  const double speed = meet ? std::ldexp(1.0, -random.integer(0, 10)) : 1, t = 0.5 + 0.5 * random.uniform();
  for (std::size_t k = 0; k < 4; ++k) query.x_t0[k] = query.x_t1[k] = random.point();
  if (meet) {
    auto& x = query.x_t0;
    const double a = 0.25 + 0.2 * random.uniform(), b = 0.25 + 0.2 * random.uniform();
    if (kind == PairKind::kVf) {
      x[0] = x[1] + scaled(a, x[2] - x[1]) + scaled(b, x[3] - x[1]);
    } else {
      const auto shift = (x[0] + scaled(a, x[1] - x[0])) - (x[2] + scaled(b, x[3] - x[2]));
      x[2] = x[2] + shift;
      x[3] = x[3] + shift;
    }
    query.x_t1 = x;
  }
  for (std::size_t k = 0; k < 4; ++k) {
    const auto velocity = scaled(speed, random.point());
    query.x_t0[k] = query.x_t0[k] - scaled(t, velocity);
    query.x_t1[k] = query.x_t1[k] + scaled(1 - t, velocity);
  }
  return query;
}

/// The normal is that of the exact polygon at `tick`, up to 2^-20, on the side of the origin.
void expect_normal(const Query& query, const PlanePassage& passage) {
  const Rational t = exact(detail::time_of(passage.tick));
  const auto d = testing::exact_corners(query.kind, testing::exact_points(query.x_t0, query.x_t1, t));
  const Rational3 n = exact(passage.normal), real = cross(d[1] - d[0], d[2] - d[0]);
  const Rational along = dot(n, real), squared = dot(real, real);
  EXPECT_TRUE(along * dot(real, d[0]) > 0);
  EXPECT_TRUE(testing::squared(along) >= squared * (1 - testing::scaled_exactly(1, -20)));
  EXPECT_NEAR(dot(n, n).get_d(), 1, 0x1p-48);
}

}  // namespace

TEST(PlanePassage, SaysNothingThatIsNotExactlySo) {
  Random random(71);
  std::array<int, 3> count = {};
  for (int i = 0; i < 12000; ++i) {
    const Query query = random_query(random, testing::kMeshKinds[i % 2]);
    const PlanePassage passage = query.passage();
    ++count[static_cast<std::size_t>(passage.passage)];
    EXPECT_LE(passage.intervals, 48);
    if (passage.passage == Passage::kUnclear) continue;
    const bool is_vf = query.kind == PairKind::kVf;
    const auto x_t0 = for_checker(query.x_t0), x_t1 = for_checker(query.x_t1);
    const bool touches =
        (is_vf ? verify::exact_vf_motion : verify::exact_ee_motion)(x_t0, x_t1, verify::Detail::kDecision).touches;
    ASSERT_EQ(touches, passage.passage == Passage::kContact);
    if (!touches) continue;
    const double toi = detail::time_of(passage.tick);
    EXPECT_GE(verify::compare_first_touch(x_t0, x_t1, is_vf, toi), 0);
    EXPECT_LE(verify::compare_first_touch(x_t0, x_t1, is_vf, toi + 0x1p-36), 0);
    const int exponent = detail::make_pair_motion<double>(query.kind, query.x_t0, query.x_t1).exponent;
    const double gap = detail::times_power_upper(passage.gap, exponent);
    EXPECT_TRUE((is_vf ? verify::vf_within_at : verify::ee_within_at)(x_t0, x_t1, toi, gap));
    EXPECT_LE(passage.gap, detail::kAlarmGap);
    expect_normal(query, passage);
  }
  EXPECT_GT(count[static_cast<std::size_t>(Passage::kSeparated)], 3000);
  EXPECT_GT(count[static_cast<std::size_t>(Passage::kContact)], 3000);
  EXPECT_LT(count[static_cast<std::size_t>(Passage::kUnclear)], 1000);
}

/// Contacts with a border of a feature, and those that begin together with the step, need the search.
TEST(PlanePassage, LeavesWhatPlainDoublesCannotTell) {
  const detail::Double3 a = {0, 0, 0}, b = {1, 0, 0}, c = {0, 1, 0};
  const auto drop = [&](const detail::Double3& from, const detail::Double3& to) {
    return Query{PairKind::kVf, {from, a, b, c}, {to, a, b, c}}.passage().passage;
  };
  EXPECT_EQ(drop({0.25, 0.25, 1}, {0.25, 0.25, -0.5}), Passage::kContact);
  EXPECT_EQ(drop({0.75, 0.75, 1}, {0.75, 0.75, -0.5}), Passage::kSeparated);
  EXPECT_EQ(drop({0.25, 0.25, 1}, {0.25, 0.25, 0.5}), Passage::kSeparated);
  EXPECT_EQ(drop({0.25, 0, 1}, {0.25, 0, -0.5}), Passage::kUnclear);
  EXPECT_EQ(drop({0.25, 0.25, 0}, {0.25, 0.25, 1}), Passage::kUnclear);
  EXPECT_EQ(drop({0.25, 0.25, 1}, {0.25, 0.25, 0}), Passage::kUnclear);
  EXPECT_EQ(drop({0.25, 0.25, 0}, {0.5, 0.25, 0}), Passage::kUnclear);
  const Query flat{PairKind::kVf, {detail::Double3{0.25, 0, 1}, a, b, b}, {detail::Double3{0.25, 0, -1}, a, b, b}};
  EXPECT_EQ(flat.passage().passage, Passage::kUnclear);
}

}  // namespace selvage
