// The geometric shrinker: what it returns still fails, is simple, and took little work.
#include "fuzz/shrink/shrink_query.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "fuzz/oracle/query_property.h"
#include "tests/fuzz/bad_kernels.h"
#include "tests/fuzz/query_cases.h"

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
    const auto failure_of = [&](const MotionQuery& query) {
      ChoiceSource unused = ChoiceSource::from_words({});
      return ccd.check(query, kernel, unused).failure;
    };
    for (const Stream& stream : query_streams(kPairKinds, 1)) {
      for (std::int64_t number = 0; number < diluted(stream, 2); ++number) {
        ChoiceSource source = source_of_case(3, stream, number);
        const MotionQuery query = draw_query(stream, source);
        const std::string_view what = failure_of(query);
        if (what.empty()) continue;
        const Shrunk shrunk = shrink(query, [&](const MotionQuery& simpler) { return failure_of(simpler) == what; });
        EXPECT_EQ(failure_of(shrunk.query), what);
        EXPECT_LE(cost_of(shrunk.query), cost_of(query));
        few += cost_of(shrunk.query).non_zero <= 12 ? 1 : 0;
        EXPECT_LT(shrunk.trials, 5000);
        ++shrunk_failures;
      }
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
