#include "verify/arithmetic/fp_guard.h"

#include <array>
#include <cfenv>
#include <vector>

#include <gtest/gtest.h>

#include "tests/fp_control.h"
#include "verify/check.h"
#include "verify/decision/exact_overlap.h"

namespace selvage::verify {

using testing::fp_control;
using testing::set_fp_control;

TEST(FpGuard, RoundsToNearestInsideAndRestoresOutside) {
  ASSERT_EQ(std::fesetround(FE_UPWARD), 0);
  volatile double one = 1, tiny = 0x1p-60;
  double inside = 0;
  {
    const FpGuard guard;
    inside = one + tiny;
  }
  const double outside = one + tiny;
  std::fesetround(FE_TONEAREST);
  EXPECT_EQ(inside, 1.0);
  EXPECT_EQ(outside, 1.0 + 0x1p-52);
}

TEST(FpGuard, WhatChangesInsideStaysThere) {
  {
    const FpGuard guard;
    ASSERT_EQ(std::fesetround(FE_UPWARD), 0);
  }
  volatile double one = 1, tiny = 0x1p-60;
  const double after = one + tiny;
  std::fesetround(FE_TONEAREST);
  EXPECT_EQ(after, 1.0);
}

#if defined(__x86_64__)  // processors for AArch64 need not have traps
// A host that traps: what is finite is decided all the same.
TEST(FpGuard, ChecksOfFiniteInputTrapNothing) {
  const std::vector<std::array<std::int32_t, 3>> faces = {{0, 1, 2}, {3, 4, 5}};
  const Surface surface{faces, {}};
  const std::vector<Point> at_one_place(6, Point{2, 2, 2});
  const std::vector<Point> large = {{0, 0, 0},     {1e200, 0, 0},     {0, 1e200, 0},
                                    {0, 0, 1e200}, {1e200, 0, 1e200}, {0, 1e200, 1e200}};
  const unsigned found = fp_control();
  set_fp_control((found & ~0x3fU) & ~0x0680U);  // no flags; invalid operations, divisions by zero and overflows trap
  const CheckResult still = check_motion(surface, at_one_place, at_one_place, {});
  const CheckResult frame = check_frame(surface, large, {});
  const bool covers =
      exact_overlap({0, 1, 2}, {large[0], large[1], large[2]}, {3, 4, 5}, {large[3], large[4], large[5]}).kind !=
      OverlapKind::kNone;
  const unsigned after = fp_control();
  set_fp_control(found);
  EXPECT_GT(still.violations_total.total(), 0);
  EXPECT_EQ(frame.violations_total.total(), 0);
  EXPECT_FALSE(covers);
  EXPECT_EQ(after & 0x1f80U, found & 0x1f80U & ~0x0680U);
}
#endif

TEST(FpGuard, KeepsSubnormalsInsideAndRestoresOutside) {
  const unsigned found = fp_control();
  set_fp_control(found | testing::kFlushing);  // as a library built with -ffast-math leaves it
  volatile double subnormal = 0x1p-1060, half = 0.5, one = 1;
  double halved = 0, same = 0;
  {
    const FpGuard guard;
    halved = subnormal * half;
    same = subnormal * one;
  }
  const double flushed = subnormal * one;
  set_fp_control(found);
  EXPECT_EQ(halved, 0x1p-1061);
  EXPECT_EQ(same, 0x1p-1060);
  EXPECT_EQ(flushed, 0.0);
}

}  // namespace selvage::verify
