#include "kernel/fp_env.h"

#include <cfenv>

#include <gtest/gtest.h>

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

namespace selvage {

namespace {

/// Leaves the environment as it was, whatever a test does.
class FpEnvTest : public ::testing::Test {
 protected:
  FpEnvTest() { std::fegetenv(&saved_); }
  ~FpEnvTest() override { std::fesetenv(&saved_); }

 private:
  std::fenv_t saved_;
};

constexpr int kDirections[] = {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO};

}  // namespace

TEST_F(FpEnvTest, TheBuildItselfHasNoDefect) { EXPECT_EQ(fp_env_defects(), 0U); }

TEST_F(FpEnvTest, EveryDirectedRoundingIsSeenAndRepaired) {
  for (const int direction : kDirections) {
    std::fesetround(direction);
    EXPECT_TRUE((fp_env_defects() & kFpRounding) != 0);
    {
      const FpEnvGuard guard;
      EXPECT_TRUE(guard.repaired());
      EXPECT_EQ(fp_env_defects(), 0U);
    }
    EXPECT_EQ(std::fegetround(), direction);
  }
}

TEST_F(FpEnvTest, WhatChangesInsideTheGuardStaysThere) {
  for (const int direction : kDirections) {
    {
      const FpEnvGuard guard;
      std::fesetround(direction);
    }
    EXPECT_EQ(fp_env_defects(), 0U);
  }
}

TEST_F(FpEnvTest, ACleanEnvironmentIsLeftAlone) {
  const FpEnvGuard guard;
  EXPECT_FALSE(guard.repaired());
}

#if defined(__SSE2__)

constexpr unsigned kFlushToZero = 0x8000, kDenormalsAreZero = 0x0040, kInvalidMask = 0x0080;

TEST_F(FpEnvTest, FlushingIsSeenAndRepaired) {
  const unsigned clean = _mm_getcsr();
  struct Case {
    unsigned bits, defects;
  };
  for (const Case& c : {Case{kFlushToZero, kFpFlush}, Case{kDenormalsAreZero, kFpDenormals},
                        Case{kFlushToZero | kDenormalsAreZero, kFpFlush | kFpDenormals}}) {
    _mm_setcsr(clean | c.bits);
    const unsigned defects = fp_env_defects();
    bool repaired = false;
    unsigned inside = 1;
    {
      const FpEnvGuard guard;
      repaired = guard.repaired();
      inside = fp_env_defects();
    }
    const unsigned after = _mm_getcsr();
    _mm_setcsr(clean);
    EXPECT_EQ(defects, c.defects);
    EXPECT_TRUE(repaired);
    EXPECT_EQ(inside, 0U);
    EXPECT_EQ(after & (kFlushToZero | kDenormalsAreZero), c.bits);
  }
}

TEST_F(FpEnvTest, TrapsAreOffInsideTheGuard) {
  const unsigned clean = _mm_getcsr();
  _mm_setcsr(clean & ~kInvalidMask);
  bool masked = false;
  {
    const FpEnvGuard guard;
    masked = (_mm_getcsr() & kInvalidMask) != 0;
  }
  const unsigned after = _mm_getcsr();
  _mm_setcsr(clean);
  EXPECT_TRUE(masked);
  EXPECT_EQ(after & kInvalidMask, 0U);
}

#endif

}  // namespace selvage
