#include "kernel/fp_env.h"

#include <cfenv>
#include <vector>

#include <gtest/gtest.h>

#include "tests/fp_control.h"

namespace selvage {

using testing::fp_control;
using testing::set_fp_control;

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

TEST_F(FpEnvTest, FlushingIsSeenAndRepaired) {
  const unsigned clean = fp_control();
  struct Case {
    unsigned bits, defects;
  };
  std::vector<Case> cases = {{testing::kFlushing, kFpFlush | kFpDenormals}};
#if defined(__x86_64__)
  cases.push_back({testing::kFlushToZero, kFpFlush});
  cases.push_back({testing::kDenormalsAreZero, kFpDenormals});
#endif
  for (const Case& c : cases) {
    set_fp_control(clean | c.bits);
    const unsigned defects = fp_env_defects();
    bool repaired = false;
    unsigned inside = 1;
    {
      const FpEnvGuard guard;
      repaired = guard.repaired();
      inside = fp_env_defects();
    }
    const unsigned after = fp_control();
    set_fp_control(clean);
    EXPECT_EQ(defects, c.defects);
    EXPECT_TRUE(repaired);
    EXPECT_EQ(inside, 0U);
    EXPECT_EQ(after & testing::kFlushing, c.bits);
  }
}

// Processors for AArch64 need not have traps.
#if defined(__x86_64__)

TEST_F(FpEnvTest, TrapsAreOffInsideTheGuard) {
  constexpr unsigned kInvalidMask = 0x0080;
  const unsigned clean = fp_control();
  set_fp_control(clean & ~kInvalidMask);
  bool masked = false;
  {
    const FpEnvGuard guard;
    masked = (fp_control() & kInvalidMask) != 0;
  }
  const unsigned after = fp_control();
  set_fp_control(clean);
  EXPECT_TRUE(masked);
  EXPECT_EQ(after & kInvalidMask, 0U);
}
#endif

}  // namespace selvage
