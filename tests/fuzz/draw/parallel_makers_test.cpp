// How near what is made beside a gap comes, by exact arithmetic.
#include <gtest/gtest.h>

#include "fuzz/draw/query_makers.h"
#include "fuzz/oracle/closest_approach.h"

namespace selvage::fuzz {
namespace {

constexpr std::uint64_t kQueries = 1000;
constexpr std::array<double, 3> kHints{0, 1, 0.5};

/// Of the queries made for `gap`, those whose features come within so many times the gap. None may touch.
std::uint64_t count_within(double times, const DeclaredGap& gap) {
  std::uint64_t within = 0;
  for (const PairKind kind : {PairKind::kVf, PairKind::kEe}) {
    for (std::uint64_t seed = 0; seed < kQueries; ++seed) {
      ChoiceSource source = ChoiceSource::from_seed(seed);
      const MotionQuery query = make::beside_gap(source, kind, gap);
      EXPECT_TRUE(is_in_domain(query)) << seed;
      EXPECT_FALSE(exact_motion(query, verify::Detail::kDecision).touches) << seed;
      within += closest_approach(query, times * gap.of(query), kHints, kEnoughTests) == Approach::kWithin ? 1 : 0;
    }
  }
  return within;
}

}  // namespace

TEST(ParallelMakers, WhatIsMadeBesideAGapLiesOnBothSidesOfItAndClose) {
  for (const DeclaredGap& gap : {DeclaredGap{1e-6, 0}, DeclaredGap{0x1p-1071, 0x1p-38}, DeclaredGap{0, 1e-6},
                                 DeclaredGap{1e-3, 1e-9}, DeclaredGap{1e150, 0}}) {
    const auto share = [&](double from, double to) {
      return static_cast<double>(count_within(to, gap) - count_within(from, gap)) / (2 * kQueries);
    };
    EXPECT_GT(share(0.25, 1), 0.3) << gap.tolerance;
    EXPECT_GT(share(1, 1.25), 0.1) << gap.tolerance;
    EXPECT_GT(share(1.25, 2), 0.1) << gap.tolerance;
    EXPECT_GT(share(2, 300), 0.15) << gap.tolerance;
  }
}

}  // namespace selvage::fuzz
