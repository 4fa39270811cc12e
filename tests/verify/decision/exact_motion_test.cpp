// Hand-derived answers: generic and degenerate motions whose first touch is known.
#include "verify/decision/exact_motion.h"

#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

namespace selvage::verify {
namespace {

using Four = std::array<Point, 4>;
using Three = std::array<Point, 3>;

struct Case {
  const char* why;
  Four x_t0, x_t1;
  MotionKind kind;
  const char *lower, *upper;  ///< of the first touch; empty where it is not dyadic
  double near = 0;
};

void expect_answer(const Case& c, const MotionAnswer& answer) {
  SCOPED_TRACE(c.why);
  EXPECT_EQ(answer.kind, c.kind);
  EXPECT_EQ(answer.touches, c.kind != MotionKind::kNone);
  if (!answer.touches) return;
  if (*c.lower != 0) {
    EXPECT_EQ(answer.first.lower, c.lower);
    EXPECT_EQ(answer.first.upper, c.upper);
  } else {
    EXPECT_LE(answer.first.lower_approx, c.near);
    EXPECT_GE(answer.first.upper_approx, c.near);
    EXPECT_LE(answer.first.upper_approx - answer.first.lower_approx, 0x1p-52);
  }
}

// The triangle (0,0,0), (4,0,0), (0,4,0), at rest.
constexpr Point kA = {0, 0, 0}, kB = {4, 0, 0}, kC = {0, 4, 0};
constexpr auto kTouch = MotionKind::kTouch, kCross = MotionKind::kCross, kNone = MotionKind::kNone;
constexpr double kHuge = std::numeric_limits<double>::max(), kTiny = std::numeric_limits<double>::denorm_min();

TEST(ExactVfMotion, HandDerivedAnswers) {
  const std::vector<Case> cases = {
      {"through the interior at 1/2", {{{1, 1, 1}, kA, kB, kC}}, {{{1, 1, -1}, kA, kB, kC}}, kCross, "1/2", "1/2"},
      {"through the interior at 1/3", {{{1, 1, 1}, kA, kB, kC}}, {{{1, 1, -2}, kA, kB, kC}}, kCross, "", "", 1.0 / 3},
      {"through the plane outside", {{{3, 3, 1}, kA, kB, kC}}, {{{3, 3, -1}, kA, kB, kC}}, kNone, "", ""},
      {"through an edge", {{{2, 2, 1}, kA, kB, kC}}, {{{2, 2, -1}, kA, kB, kC}}, kTouch, "1/2", "1/2"},
      {"through a corner", {{{4, 0, 1}, kA, kB, kC}}, {{{4, 0, -3}, kA, kB, kC}}, kTouch, "1/4", "1/4"},
      {"beside a corner by an ulp",
       {{{std::nextafter(4.0, 5), 0, 1}, kA, kB, kC}},
       {{{std::nextafter(4.0, 5), 0, -3}, kA, kB, kC}},
       kNone,
       "",
       ""},
      {"lands at t = 1", {{{1, 1, 1}, kA, kB, kC}}, {{{1, 1, 0}, kA, kB, kC}}, kTouch, "1", "1"},
      {"stops before landing", {{{1, 1, 1}, kA, kB, kC}}, {{{1, 1, kTiny}, kA, kB, kC}}, kNone, "", ""},
      {"leaves at t = 0", {{{1, 1, 0}, kA, kB, kC}}, {{{1, 1, 1}, kA, kB, kC}}, kTouch, "0", "0"},
      {"nothing moves, apart", {{{1, 1, 1}, kA, kB, kC}}, {{{1, 1, 1}, kA, kB, kC}}, kNone, "", ""},
      {"nothing moves, touching", {{{1, 1, 0}, kA, kB, kC}}, {{{1, 1, 0}, kA, kB, kC}}, kTouch, "0", "0"},
      {"slides in the plane onto the edge",
       {{{-1, 1, 0}, kA, kB, kC}},
       {{{1, 1, 0}, kA, kB, kC}},
       kTouch,
       "1/2",
       "1/2"},
      {"slides in the plane, away", {{{-1, 1, 0}, kA, kB, kC}}, {{{-2, 1, 0}, kA, kB, kC}}, kNone, "", ""},
      {"slides along an edge's line onto its end",
       {{{-2, 0, 0}, kA, kB, kC}},
       {{{2, 0, 0}, kA, kB, kC}},
       kTouch,
       "1/2",
       "1/2"},
      {"slides past a corner, tangent", {{{-4, 4, 0}, kA, kB, kC}}, {{{4, 4, 0}, kA, kB, kC}}, kTouch, "1/2", "1/2"},
      // The plane z = (2t - 1) x tilts under the point (1 - 2t, 0, 0): the cubic is a multiple of (1 - 2t)^2.
      {"double root: a tangent touch in the interior",
       {{{1, 0, 0}, {-2, -2, 2}, {2, -2, -2}, {0, 2, 0}}},
       {{{-1, 0, 0}, {-2, -2, -2}, {2, -2, 2}, {0, 2, 0}}},
       kTouch,
       "1/2",
       "1/2"},
      {"double root beside the triangle",
       {{{1, 3, 0}, {-2, -2, 2}, {2, -2, -2}, {0, 2, 0}}},
       {{{-1, 3, 0}, {-2, -2, -2}, {2, -2, 2}, {0, 2, 0}}},
       kNone,
       "",
       ""},
      {"zero-area triangle: crossing its segment",
       {{{1, 0, 1}, {0, 0, 0}, {2, 0, 0}, {4, 0, 0}}},
       {{{1, 0, -1}, {0, 0, 0}, {2, 0, 0}, {4, 0, 0}}},
       kTouch,
       "1/2",
       "1/2"},
      {"zero-area triangle: past the end of its segment",
       {{{5, 0, 1}, {0, 0, 0}, {2, 0, 0}, {4, 0, 0}}},
       {{{5, 0, -1}, {0, 0, 0}, {2, 0, 0}, {4, 0, 0}}},
       kNone,
       "",
       ""},
      {"all four points are one moving point", {{kA, kA, kA, kA}}, {{kB, kB, kB, kB}}, kTouch, "0", "0"},
      {"point triangle, hit at 3/4", {{{3, 0, 0}, kA, kA, kA}}, {{{-1, 0, 0}, kA, kA, kA}}, kTouch, "3/4", "3/4"},
      {"triangle collapses onto the point at t = 1",
       {{{0, 0, 1}, kA, kB, kC}},
       {{{0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {0, 0, 1}}},
       kTouch,
       "1",
       "1"},
      {"largest doubles",
       {{{0, 0, kHuge}, {-kHuge, -kHuge, 0}, {kHuge, -kHuge, 0}, {0, kHuge, 0}}},
       {{{0, 0, -kHuge}, {-kHuge, -kHuge, 0}, {kHuge, -kHuge, 0}, {0, kHuge, 0}}},
       kCross,
       "1/2",
       "1/2"},
      {"smallest doubles",
       {{{0, 0, kTiny}, {-kTiny, -kTiny, 0}, {kTiny, -kTiny, 0}, {0, kTiny, 0}}},
       {{{0, 0, -kTiny}, {-kTiny, -kTiny, 0}, {kTiny, -kTiny, 0}, {0, kTiny, 0}}},
       kCross,
       "1/2",
       "1/2"},
      {"both at once: passes the plane at the last moment",
       {{{0, 0, kHuge}, {-kHuge, -kHuge, 0}, {kHuge, -kHuge, 0}, {0, kHuge, 0}}},
       {{{0, 0, -kTiny}, {-kHuge, -kHuge, 0}, {kHuge, -kHuge, 0}, {0, kHuge, 0}}},
       kCross,
       "",
       "",
       1.0},
  };
  for (const Case& c : cases) expect_answer(c, exact_vf_motion(c.x_t0, c.x_t1, Detail::kFirstTime));
}

TEST(ExactEeMotion, HandDerivedAnswers) {
  // The edge from (-1,0,0) to (1,0,0), at rest.
  constexpr Point kP = {-1, 0, 0}, kQ = {1, 0, 0};
  const std::vector<Case> cases = {
      {"crosses at 1/2", {{kP, kQ, {0, -1, 1}, {0, 1, 1}}}, {{kP, kQ, {0, -1, -1}, {0, 1, -1}}}, kCross, "1/2", "1/2"},
      {"ends meet", {{kP, kQ, {1, 0, 1}, {1, 1, 1}}}, {{kP, kQ, {1, 0, -1}, {1, 1, -1}}}, kTouch, "1/2", "1/2"},
      {"past the end", {{kP, kQ, {2, -1, 1}, {2, 1, 1}}}, {{kP, kQ, {2, -1, -1}, {2, 1, -1}}}, kNone, "", ""},
      {"parallel, overlapping at 1/2",
       {{kP, kQ, {0, 0, 1}, {4, 0, 1}}},
       {{kP, kQ, {0, 0, -1}, {4, 0, -1}}},
       kTouch,
       "1/2",
       "1/2"},
      {"parallel, collinear at 1/2 but apart",
       {{kP, kQ, {2, 0, 1}, {4, 0, 1}}},
       {{kP, kQ, {2, 0, -1}, {4, 0, -1}}},
       kNone,
       "",
       ""},
      {"collinear, slides onto the end",
       {{kP, kQ, {3, 0, 0}, {5, 0, 0}}},
       {{kP, kQ, {-1, 0, 0}, {1, 0, 0}}},
       kTouch,
       "1/2",
       "1/2"},
      {"one inside the other, collinear",
       {{{-9, 0, 0}, {9, 0, 0}, {3, 0, 1}, {5, 0, 1}}},
       {{{-9, 0, 0}, {9, 0, 0}, {3, 0, -1}, {5, 0, -1}}},
       kTouch,
       "1/2",
       "1/2"},
      {"coplanar, an end reaches the other edge",
       {{kP, kQ, {0, 2, 0}, {0, 1, 0}}},
       {{kP, kQ, {0, 1, 0}, {0, -1, 0}}},
       kTouch,
       "1/2",
       "1/2"},
      {"coplanar, apart", {{kP, kQ, {0, 2, 0}, {0, 1, 0}}}, {{kP, kQ, {5, 1, 0}, {5, -1, 0}}}, kNone, "", ""},
      {"two points meet", {{kP, kP, kQ, kQ}}, {{kQ, kQ, kP, kP}}, kTouch, "1/2", "1/2"},
      {"a point and an edge",
       {{{0, 0, 1}, {0, 0, 1}, kP, kQ}},
       {{{0, 0, -7}, {0, 0, -7}, kP, kQ}},
       kTouch,
       "1/8",
       "1/8"},
  };
  for (const Case& c : cases) expect_answer(c, exact_ee_motion(c.x_t0, c.x_t1, Detail::kFirstTime));
}

TEST(ExactSelfMotion, HandDerivedAnswers) {
  struct SelfCase {
    const char* why;
    Three x_t0, x_t1;
    const char* first;  ///< empty: no touch
  };
  constexpr Point kP = {-1, 0, 0}, kQ = {1, 0, 0};
  const std::vector<SelfCase> cases = {
      {"through the opposite edge", {{{0, 1, 0}, kP, kQ}}, {{{0, -1, 0}, kP, kQ}}, "1/2"},
      {"over it", {{{0, 1, 1}, kP, kQ}}, {{{0, -1, 1}, kP, kQ}}, ""},
      {"collinear, beyond an end", {{{3, 1, 0}, kP, kQ}}, {{{3, -1, 0}, kP, kQ}}, ""},
      {"onto an end", {{{1, 1, 0}, kP, kQ}}, {{{1, -1, 0}, kP, kQ}}, "1/2"},
      {"lands at t = 1", {{{0, 1, 0}, kP, kQ}}, {{{0, 0, 0}, kP, kQ}}, "1"},
      {"starts there", {{{0, 0, 0}, kP, kQ}}, {{{0, 9, 0}, kP, kQ}}, "0"},
      {"collinear throughout, slides in", {{{5, 0, 0}, kP, kQ}}, {{{-11, 0, 0}, kP, kQ}}, "1/4"},
      {"collinear throughout, apart", {{{5, 0, 0}, kP, kQ}}, {{{2, 0, 0}, kP, kQ}}, ""},
      {"a zero-length edge, met", {{{1, 1, 1}, kP, kP}}, {{{-3, -1, -1}, kP, kP}}, "1/2"},
      {"a zero-length edge, missed", {{{1, 1, 1}, kP, kP}}, {{{-3, -1, 0}, kP, kP}}, ""},
  };
  for (const SelfCase& c : cases) {
    SCOPED_TRACE(c.why);
    const MotionAnswer answer = exact_self_motion(c.x_t0, c.x_t1, Detail::kFirstTime);
    EXPECT_EQ(answer.touches, *c.first != 0);
    if (answer.touches) {
      EXPECT_EQ(answer.first.lower, c.first);
      EXPECT_EQ(answer.first.upper, c.first);
      EXPECT_EQ(answer.kind, kTouch);
    }
  }
}

TEST(CompareFirstTouch, IsExactAtTheLastBit) {
  // Touch at 1/3, which no double is, and at 1/4 + 2^-60.
  const Four at_third_t0 = {{{1, 1, 1}, kA, kB, kC}}, at_third_t1 = {{{1, 1, -2}, kA, kB, kC}};
  EXPECT_EQ(compare_first_touch(at_third_t0, at_third_t1, true, 1.0 / 3), 1);  // the double is below 1/3
  EXPECT_EQ(compare_first_touch(at_third_t0, at_third_t1, true, std::nextafter(1.0 / 3, 1)), -1);
  const Four at_quarter_t0 = {{{1, 1, 1}, kA, kB, kC}}, at_quarter_t1 = {{{1, 1, -3}, kA, kB, kC}};
  EXPECT_EQ(compare_first_touch(at_quarter_t0, at_quarter_t1, true, 0.25), 0);
  EXPECT_EQ(compare_first_touch(at_quarter_t0, at_quarter_t1, true, std::nextafter(0.25, 0)), 1);
  EXPECT_EQ(compare_first_touch(at_quarter_t0, at_quarter_t1, true, std::nextafter(0.25, 1)), -1);
}

TEST(CompareFirstTouch, TakesEveryDouble) {
  const Four apart = {{{1, 1, 1}, kA, kB, kC}}, touching = {{{1, 1, 0}, kA, kB, kC}};
  for (const double t : {-kHuge, -1.0, 0.0, kTiny, 0.5, 1.0, 2.0, kHuge}) {
    EXPECT_EQ(compare_first_touch(apart, apart, true, t), 1) << t;
    EXPECT_EQ(compare_first_touch(touching, touching, true, t), t < 0 ? 1 : (t == 0 ? 0 : -1)) << t;
    EXPECT_EQ(compare_first_touch(apart, touching, true, t), t < 1 ? 1 : (t == 1 ? 0 : -1)) << t;
  }
  EXPECT_THROW((void)compare_first_touch(apart, apart, true, std::nan("")), std::invalid_argument);
}

TEST(ExactMotion, RefusesCoordinatesThatAreNotFinite) {
  const Four finite = {{{1, 1, 1}, kA, kB, kC}};
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    Four broken = finite;
    broken[2][1] = bad;
    EXPECT_THROW((void)exact_vf_motion(finite, broken, Detail::kDecision), std::invalid_argument);
    EXPECT_THROW((void)exact_ee_motion(broken, finite, Detail::kDecision), std::invalid_argument);
  }
}

}  // namespace
}  // namespace selvage::verify
