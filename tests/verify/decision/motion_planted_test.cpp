// Motions whose answer is known from how they were made: planted hits, planted misses, hostile environments.
#include <cmath>

#include <gmpxx.h>
#include <gtest/gtest.h>

#include "tests/fp_control.h"
#include "tests/verify/motion_families.h"
#include "verify/decision/exact_motion.h"

namespace selvage::verify {
namespace {

using testbed::Draw;
using testbed::MotionCase;
using testbed::PlantedHit;

/// The planted touch is found, at the planted time or before.
void expect_hit(const PlantedHit& hit, const MotionAnswer& answer, const char* what) {
  ASSERT_TRUE(answer.touches) << what << " planted at " << hit.numerator << "/" << hit.denominator << hit.motion;
  EXPECT_NE(answer.kind, MotionKind::kNone);
  const mpq_class planted(hit.numerator, hit.denominator), lower(answer.first.lower), upper(answer.first.upper);
  ASSERT_LE(lower, planted) << what << hit.motion;
  ASSERT_GE(lower, 0);
  ASSERT_LE(upper, 1);
  ASSERT_LE(upper - lower, mpq_class(1, mpz_class(1) << 60)) << what << hit.motion;
  // The doubles are outside, and the next ones are not.
  ASSERT_LE(mpq_class(answer.first.lower_approx), lower);
  ASSERT_GT(mpq_class(std::nextafter(answer.first.lower_approx, 2.0)), lower);
  ASSERT_GE(mpq_class(answer.first.upper_approx), upper);
  ASSERT_LT(mpq_class(std::nextafter(answer.first.upper_approx, -1.0)), upper);
}

/// 1, 0 or -1 as the first touch is later than, at or before a double near the planted time.
void expect_comparison(const PlantedHit& hit, const MotionAnswer& answer, bool is_vf) {
  const double t = static_cast<double>(hit.numerator) / hit.denominator;
  for (const double probe : {std::nextafter(t, -1.0), t, std::nextafter(t, 2.0), 0.5 * t}) {
    const int sign = compare_first_touch(hit.motion.x_t0, hit.motion.x_t1, is_vf, probe);
    const mpq_class exact(probe);
    if (exact <= mpq_class(answer.first.lower)) {
      ASSERT_EQ(sign, answer.first.lower == answer.first.upper && exact == mpq_class(answer.first.lower) ? 0 : 1)
          << probe << hit.motion;
    } else if (exact >= mpq_class(answer.first.upper)) {
      ASSERT_EQ(sign, -1) << probe << hit.motion;
    }
  }
}

TEST(PlantedHits, AreFound) {
  Draw draw(21);
  long exactly_there = 0;
  constexpr int kCases = 3000;
  for (int i = 0; i < kCases; ++i) {
    const int range = 1 + i % 6;
    const PlantedHit vf = testbed::planted_vf_hit(draw, range);
    const MotionAnswer vf_answer = exact_vf_motion(vf.motion.x_t0, vf.motion.x_t1, Detail::kFirstTime);
    ASSERT_NO_FATAL_FAILURE(expect_hit(vf, vf_answer, "vertex-face")) << i;
    ASSERT_NO_FATAL_FAILURE(expect_comparison(vf, vf_answer, true)) << i;
    const PlantedHit ee = testbed::planted_ee_hit(draw, range);
    const MotionAnswer ee_answer = exact_ee_motion(ee.motion.x_t0, ee.motion.x_t1, Detail::kFirstTime);
    ASSERT_NO_FATAL_FAILURE(expect_hit(ee, ee_answer, "edge-edge")) << i;
    ASSERT_NO_FATAL_FAILURE(expect_comparison(ee, ee_answer, false)) << i;
    const PlantedHit self = testbed::planted_self_hit(draw, range);
    const MotionAnswer self_answer =
        exact_self_motion(self.motion.three_t0(), self.motion.three_t1(), Detail::kFirstTime);
    ASSERT_NO_FATAL_FAILURE(expect_hit(self, self_answer, "self")) << i;
    if (mpq_class(vf_answer.first.upper) >= mpq_class(vf.numerator, vf.denominator)) ++exactly_there;
  }
  EXPECT_GT(exactly_there, kCases / 3);  // else most plants are hidden behind earlier touches
}

/// Constructed times: a point falls on a triangle at rest at the time t, for any double t in (0,1].
TEST(CompareFirstTouch, IsExactAtConstructedTimes) {
  Draw draw(23);
  for (int i = 0; i < 2000; ++i) {
    // From height h by h + d: first touch at h / (h + d), t and the sum exact in 53 bits.
    const double h = draw.integer(1, 1 << 26), d = draw.integer(0, 1 << 26);
    const MotionCase motion{{{{1, 1, h}, {0, 0, 0}, {4, 0, 0}, {0, 4, 0}}},
                            {{{1, 1, -d}, {0, 0, 0}, {4, 0, 0}, {0, 4, 0}}}};
    const mpq_class first = mpq_class(h) / mpq_class(h + d);
    const double near = h / (h + d);
    for (const double t : {std::nextafter(near, 0), near, std::nextafter(near, 2)}) {
      ASSERT_EQ(compare_first_touch(motion.x_t0, motion.x_t1, true, t),
                cmp(first, mpq_class(t)) < 0 ? -1 : (first == t ? 0 : 1))
          << t << motion;
    }
  }
}

TEST(PlantedMisses, AreNotReported) {
  Draw draw(22);
  for (int i = 0; i < 5000; ++i) {
    const int range = 1 + i % 6;
    const MotionCase vf = testbed::planted_miss(draw, range, 1);
    ASSERT_FALSE(exact_vf_motion(vf.x_t0, vf.x_t1, Detail::kDecision).touches) << i << vf;
    const MotionCase ee = testbed::planted_miss(draw, range, 2);
    ASSERT_FALSE(exact_ee_motion(ee.x_t0, ee.x_t1, Detail::kDecision).touches) << i << ee;
    ASSERT_FALSE(exact_self_motion(vf.three_t0(), vf.three_t1(), Detail::kDecision).touches) << i << vf;
  }
}

TEST(ExactMotion, RepairsAHostileEnvironmentAndRestoresIt) {
  // Subnormal coordinates: with FTZ or DAZ all differences of doubles are zero. (Measured: without the guard these
  // answers are the same, as the filters leave such pairs to exact arithmetic; fp_guard_test.cpp holds the guard
  // itself.)
  Draw draw(24);
  using namespace selvage::testing;
  const unsigned usual = fp_control();
  for (const unsigned hostile : {kFlushing, kRoundUp, kRoundDown, kRoundToZero, kFlushing | kRoundToZero}) {
    for (int i = 0; i < 200; ++i) {
      MotionCase motion = i % 2 == 0 ? testbed::planted_miss(draw, 3, 1) : testbed::planted_vf_hit(draw, 3).motion;
      for (auto* points : {&motion.x_t0, &motion.x_t1}) {
        for (Point& point : *points) {
          for (double& coordinate : point) coordinate = std::ldexp(coordinate, -1074);
        }
      }
      set_fp_control(usual | hostile);
      const bool touches = exact_vf_motion(motion.x_t0, motion.x_t1, Detail::kDecision).touches;
      const int sign = compare_first_touch(motion.x_t0, motion.x_t1, true, 1.0);
      const unsigned after = fp_control();
      set_fp_control(usual);
      ASSERT_EQ(touches, i % 2 == 1) << i << motion;
      ASSERT_LE(touches ? sign : 0, 0);
      ASSERT_EQ(after & ~kExceptionFlags, (usual | hostile) & ~kExceptionFlags);
    }
  }
}

}  // namespace
}  // namespace selvage::verify
