#include "verify/arithmetic/fp_guard.h"

#include <cfenv>

#include <gtest/gtest.h>

#if defined(__x86_64__)
#include <xmmintrin.h>
#endif

namespace selvage::verify {

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

#if defined(__x86_64__)
TEST(FpGuard, KeepsSubnormalsInsideAndRestoresOutside) {
  const unsigned found = _mm_getcsr();
  _mm_setcsr(found | 0x8040U);  // FTZ and DAZ, as a library built with -ffast-math leaves them
  volatile double subnormal = 0x1p-1060, half = 0.5, one = 1;
  double halved = 0, same = 0;
  {
    const FpGuard guard;
    halved = subnormal * half;
    same = subnormal * one;
  }
  const double flushed = subnormal * one;
  _mm_setcsr(found);
  EXPECT_EQ(halved, 0x1p-1061);
  EXPECT_EQ(same, 0x1p-1060);
  EXPECT_EQ(flushed, 0.0);
}
#endif

}  // namespace selvage::verify
