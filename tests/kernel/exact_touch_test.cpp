// Touches that are exact at t = 1 and nowhere else, and misses by as little as doubles can say: here filters with
// absolute tolerances or a wrong scale fail (a widely used one misses a tenth to a fifth of the touches at small
// scales).
#include <algorithm>
#include <cmath>
#include <cstdlib>

#include <gtest/gtest.h>

#include "tests/kernel/exact_answer.h"
#include "tests/kernel/pair_kinds.h"
#include "tests/kernel/random_points.h"

namespace selvage {

using testing::Random;
using Points = std::array<Vec3, 4>;

namespace {

/// The environment variable SELVAGE_EXACT_TOUCH_CASES sets the number of cases of the exact touches.
int touch_cases() {
  const char* named = std::getenv("SELVAGE_EXACT_TOUCH_CASES");
  return named != nullptr ? std::atoi(named) : 20000;
}

struct Touch {
  Points x_t0, x_t1;
};

/// The first point of the first feature lands on the first of the second at t = 1, bit by bit; before that a plane
/// x = const separates the features at every t.
Touch random_touch(Random& random, PairKind kind) {
  const std::size_t second = kind == PairKind::kVf ? 1 : 2;
  const double scale = std::ldexp(1.0, random.integer(-300, 300));
  const auto offset = [&random, scale] {
    return random.chance(2) ? 0.0 : scale * std::ldexp(random.uniform(), random.integer(0, 40));
  };
  const Vec3 shift = {offset(), offset(), offset()};
  for (;;) {
    Touch touch;
    for (Points* x : {&touch.x_t0, &touch.x_t1}) {
      for (std::size_t k = 0; k < 4; ++k) {
        Vec3 p = detail::to_vec3(random.point());
        p[0] = k < second ? -std::fabs(p[0]) : std::fabs(p[0]);
        (*x)[k] = scale * p + shift;
      }
    }
    touch.x_t1[0][0] = shift[0];
    touch.x_t1[second] = touch.x_t1[0];
    bool apart = true;  // rounding to the offset may have closed the gap
    for (std::size_t i = 0; i < second; ++i) {
      for (std::size_t j = second; j < 4; ++j) {
        apart &= touch.x_t0[i][0] < touch.x_t0[j][0];
        apart &= touch.x_t1[i][0] < touch.x_t1[j][0] || (i == 0 && j == second);
      }
    }
    if (apart) return touch;
  }
}

/// One axis for another, so that no axis is special.
void turn(Points& x, int by) {
  for (Vec3& p : x) p = Vec3(p[by % 3], p[(by + 1) % 3], p[(by + 2) % 3]);
}

}  // namespace

TEST(ExactTouch, AtTheEndIsNeverMissed) {
  Random random(91);
  int missed = 0, unresolved = 0, late = 0;
  const int cases = touch_cases();
  for (int i = 0; i < cases; ++i) {
    const PairKind kind = testing::kMeshKinds[i % 2];
    Touch touch = random_touch(random, kind);
    turn(touch.x_t0, i % 3);
    turn(touch.x_t1, i % 3);
    const CcdResult result = testing::kernel_answer(kind, touch.x_t0, touch.x_t1);
    missed += result.verdict == CcdVerdict::kSeparated;
    unresolved += result.verdict == CcdVerdict::kUnresolved;
    late += result.toi_lower > 1;
  }
  EXPECT_EQ(missed, 0) << "of " << cases;
  EXPECT_EQ(unresolved, 0) << "of " << cases;
  EXPECT_EQ(late, 0) << "of " << cases;
}

TEST(ExactTouch, ConstructedTouchesAreTouches) {
  Random random(92);
  for (int i = 0; i < 300; ++i) {
    const PairKind kind = testing::kMeshKinds[i % 2];
    const Touch touch = random_touch(random, kind);
    const auto truth = testing::exact_answer(kind, touch.x_t0, touch.x_t1, verify::Detail::kFirstTime);
    EXPECT_TRUE(truth.touches);
    EXPECT_EQ(truth.first.lower, "1");
  }
}

TEST(NearMiss, ByTheLastBitOfTheEndIsSeparated) {
  Random random(93);
  for (int i = 0; i < 4000; ++i) {
    // Down to a height that is next to nothing over the inside of the other feature, or up from it.
    const PairKind kind = testing::kMeshKinds[i % 2];
    const double x = 0.25 * random.uniform(), y = 0.25 * random.uniform(),
                 low = std::ldexp(1.0, -random.integer(30, 80));
    Points above = kind == PairKind::kVf ? Points{Vec3(x, y, 1), Vec3(-1, -1, 0), Vec3(2, -1, 0), Vec3(-1, 2, 0)}
                                         : Points{Vec3(x, -1, 1), Vec3(y, 1, 1), Vec3(-1, 0, 0), Vec3(1, 0, 0)};
    Points at_end = above;
    at_end[0][2] = low;
    if (kind == PairKind::kEe) at_end[1][2] = low;
    turn(above, i % 3);
    turn(at_end, i % 3);
    EXPECT_EQ(testing::kernel_answer(kind, above, at_end).verdict, CcdVerdict::kSeparated) << low;
    EXPECT_EQ(testing::kernel_answer(kind, at_end, above).verdict, CcdVerdict::kSeparated) << low;
  }
}

TEST(NearMiss, ByTheRoundingOfTheEndIsToldFromATouch) {
  Random random(95);
  int touches = 0;
  constexpr int kCases = 4000;
  for (int i = 0; i < kCases; ++i) {
    // A vertex arrives at a rounded point of a face, an edge at one of an edge, before the plane or behind it.
    const PairKind kind = testing::kMeshKinds[i % 2];
    const double size = std::ldexp(1.0, random.integer(-6, 0));
    Points x_t1;
    for (Vec3& p : x_t1) p = detail::to_vec3(random.point()) + Vec3(random.chance(2) ? 5 : 0, 0, 0);
    const double wa = 0.1 + 0.3 * std::fabs(random.uniform()), wb = 0.1 + 0.3 * std::fabs(random.uniform());
    const Vec3 from = size * detail::to_vec3(random.point());
    Points x_t0 = x_t1;
    if (kind == PairKind::kVf) {
      x_t1[0] = (1 - wa - wb) * x_t1[1] + wa * x_t1[2] + wb * x_t1[3];
      x_t0[0] = x_t1[0] + from;
    } else {
      const Vec3 shift = (1 - wa) * x_t1[2] + wa * x_t1[3] - (1 - wb) * x_t1[0] - wb * x_t1[1];
      for (const std::size_t k : {0U, 1U}) {
        x_t1[k] += shift;
        x_t0[k] = x_t1[k] + from;
      }
    }
    const bool touch = testing::exact_answer(kind, x_t0, x_t1, verify::Detail::kDecision).touches;
    touches += touch;
    const CcdVerdict verdict = testing::kernel_answer(kind, x_t0, x_t1).verdict;
    EXPECT_EQ(verdict, touch ? CcdVerdict::kCollides : CcdVerdict::kSeparated);
  }
  EXPECT_GT(touches, kCases / 4);
  EXPECT_LT(touches, kCases * 3 / 4);
}

TEST(NearMiss, ByAnUlpBesideAnEdgeIsToldFromATouch) {
  Random random(94);
  int touches = 0;
  constexpr int kCases = 4000;
  for (int i = 0; i < kCases; ++i) {
    // A vertex passes through the plane of a face on a rounded point of its edge, on this side or that of it.
    Points x_t0;
    for (Vec3& p : x_t0) p = Vec3(random.uniform(), random.uniform(), 0);
    const double s = 0.5 + 0.4 * random.uniform();
    x_t0[0] = (1 - s) * x_t0[1] + s * x_t0[2];
    Points x_t1 = x_t0;
    x_t0[0][2] = 0.5 + std::fabs(random.uniform());
    x_t1[0][2] = -0.5 - std::fabs(random.uniform());
    turn(x_t0, i % 3);
    turn(x_t1, i % 3);
    const bool touch = testing::exact_answer(PairKind::kVf, x_t0, x_t1, verify::Detail::kDecision).touches;
    touches += touch;
    const CcdVerdict verdict = testing::kernel_answer(PairKind::kVf, x_t0, x_t1).verdict;
    EXPECT_EQ(verdict, touch ? CcdVerdict::kCollides : CcdVerdict::kSeparated);
  }
  EXPECT_GT(touches, kCases / 4);
  EXPECT_LT(touches, kCases * 3 / 4);
}

}  // namespace selvage
