#include "cli/process/hostile_fp.h"

#include <gtest/gtest.h>

#include "tests/fp_control.h"

namespace selvage::cli {

TEST(HostileFp, EveryEnvironmentIsAnotherForItsScopeAlone) {
  const unsigned found = testing::fp_control() & ~testing::kExceptionFlags;
  unsigned before = found;
  for (const HostileFp& hostile : hostile_environments()) {
    unsigned inside = found;
    {
      const HostileScope scope(hostile);
      inside = testing::fp_control() & ~testing::kExceptionFlags;
    }
    const unsigned after = testing::fp_control() & ~testing::kExceptionFlags;
    EXPECT_NE(inside, found) << hostile.name;
    EXPECT_NE(inside, before) << hostile.name;
    EXPECT_EQ((inside & testing::kFlushing) == testing::kFlushing, hostile.flushes) << hostile.name;
    EXPECT_EQ(after, found) << hostile.name;
    before = inside;
  }
}

}  // namespace selvage::cli
