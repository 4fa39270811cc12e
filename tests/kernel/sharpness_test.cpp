// How much of each bound of kernel/rounding.h rounding can use (bound_shares.h). The shares stand in docs/guarantee.md.
#include <algorithm>
#include <cstdio>

#include <gtest/gtest.h>

#include "tests/kernel/bound_shares.h"

namespace selvage {

TEST(Sharpness, OfEveryBoundIsBetweenATwentiethAndOne) {
  constexpr int kClimbs = 20;
  for (const testing::Bound& bound : testing::bounds()) {
    testing::Random random(101);
    double share = 0;
    for (int i = 0; i < kClimbs; ++i) share = std::max(share, testing::climb(bound, random));
    std::printf("[ share    ] %5.1f %% of the bound: %s\n", 100 * share, bound.name);
    EXPECT_GE(share, bound.least_share) << bound.name;
    EXPECT_LE(share, 1) << bound.name;
  }
}

}  // namespace selvage
