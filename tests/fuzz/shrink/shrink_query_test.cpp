// The geometric shrinker: what it returns still fails, is simple, and took little work.
#include "fuzz/shrink/shrink_query.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "fuzz/campaign/query_campaign.h"
#include "tests/fuzz/bad_kernels.h"

namespace selvage::fuzz {
namespace {

/// Opens the interval of time: what touches at t = 1 alone is lost (MK1).
CcdResult open_at_end(const MotionQuery& query) {
  const CcdResult result = selvage_kernel(query);
  return result.verdict == CcdVerdict::kCollides && result.toi_lower > 1 - 0x1p-40 ? always_separated(query) : result;
}

TEST(ShrinkQuery, PlantedDefectsComeDownToAFewShortNumbers) {
  const QueryProperty& ccd = query_properties()[0];
  for (const CcdKernel kernel : {CcdKernel{open_at_end}, CcdKernel{late}, CcdKernel{always_separated}}) {
    int shrunk_failures = 0, few = 0;
    for (const Chunk& chunk : make_chunks(0, 2)) {
      (void)run_chunk(ccd, kernel, 3, chunk, [&](const Failure& failure) {
        const auto still_fails = [&](const MotionQuery& query) {
          ChoiceSource unused = ChoiceSource::from_words({});
          return ccd.check(query, kernel, unused).failure == failure.what;
        };
        const Shrunk shrunk = shrink(failure.kept.query, still_fails);
        EXPECT_TRUE(still_fails(shrunk.query));
        EXPECT_LE(cost_of(shrunk.query), cost_of(failure.kept.query));
        few += cost_of(shrunk.query).non_zero <= 12 ? 1 : 0;
        EXPECT_LT(shrunk.trials, 5000);
        ++shrunk_failures;
      });
    }
    EXPECT_GT(shrunk_failures, 3);
    EXPECT_GE(few * 10, shrunk_failures * 9);  // what lives in the last bits stays long
  }
}

// Neither has an exponent, and NaN no place in an order.
TEST(ShrinkQuery, WhatIsNotFiniteCostsMostAndIsNotScaled) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN(), kInf = std::numeric_limits<double>::infinity();
  MotionQuery query;
  for (auto* x : {&query.x_t0, &query.x_t1}) x->fill(Vec3::Constant(1));
  for (const double odd : {kNan, kInf}) {
    query.x_t0[0] = {odd, 1, 1};
    EXPECT_EQ(cost_of(query).bits, 64 + 23);
    EXPECT_EQ(cost_of(query).distinct, 1);
    EXPECT_EQ(cost_of(query).exponents, 0);
    const auto still_fails = [](const MotionQuery& one) { return !one.x_t0[0].allFinite(); };
    EXPECT_FALSE(std::isfinite(shrink(query, still_fails).query.x_t0[0].x()));
  }
}

TEST(ShrinkQuery, WhatCannotBeSimplerStays) {
  MotionQuery query;
  query.kind = PairKind::kEe;
  query.x_t0[1] = Vec3(1, 0, 0);
  const auto only_itself = [&](const MotionQuery& other) {
    return other.x_t0 == query.x_t0 && other.x_t1 == query.x_t1;
  };
  EXPECT_EQ(shrink(query, only_itself).query.x_t0, query.x_t0);
}

}  // namespace
}  // namespace selvage::fuzz
