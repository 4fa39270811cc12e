// How much of each bound of kernel/arithmetic/rounding.h rounding can use (bound_shares.h). The shares stand in
// docs/guarantee-kernel.md.
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

// Climbs stop at 78 %; a random search over one axis found this corner.
TEST(Sharpness, OfACornerIsMoreThanNineTenths) {
  const auto along_all_axes = [](double p, double q) {
    return detail::PairPoints{{{p, p, p}, {q, q, q}, {q, q, q}, {q, q, q}}};
  };
  testing::BoundCase corner;
  corner.x_t0 = along_all_axes(0x1.098d05f83f8b5p-1, -0x1.ed33ffa531ec4p-40);
  corner.x_t1 = along_all_axes(0x1.022e4d3a5fd0fp-1, -0x1.dc28e808d7d08p-33);
  corner.tick[0] = static_cast<detail::Tick>(0x1.8b5cfd2385280p-7 * static_cast<double>(detail::kTicks));
  const testing::Bound& point = testing::bounds().front();
  const double share = point.share_of(corner);
  std::printf("[ share    ] %5.1f %% of the bound: %s\n", 100 * share, point.name);
  EXPECT_GE(share, 0.9);
  EXPECT_LE(share, 1);
}

}  // namespace selvage
