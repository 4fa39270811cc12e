#include "fuzz/base/choice_source.h"

#include <algorithm>
#include <array>
#include <vector>

#include <gtest/gtest.h>

namespace selvage::fuzz {
namespace {

// Values of a second splitmix64, written in another language: a seed must mean the same cases on every machine.
TEST(ChoiceSource, SeedsMeanTheSameEverywhere) {
  ChoiceSource source = ChoiceSource::from_seed(0);
  EXPECT_EQ(source.n(0xffffffff), 2802244911U);
  EXPECT_EQ(source.n(0xffffffff), 3011683077U);
  EXPECT_EQ(source.n(1000), 524U);
  EXPECT_EQ(source.n(2), 0U);
  EXPECT_EQ(mix(1, 2), 0x7adda25fcf93ee03U);
}

TEST(ChoiceSource, NeighbouringSeedsShareNothing) {
  ChoiceSource a = ChoiceSource::from_seed(7);
  ChoiceSource b = ChoiceSource::from_seed(8);
  std::vector<std::uint32_t> from_a, from_b;
  for (int i = 0; i < 100; ++i) from_a.push_back(a.n(1U << 31));
  for (int i = 0; i < 100; ++i) from_b.push_back(b.n(1U << 31));
  for (const std::uint32_t x : from_a) EXPECT_EQ(std::count(from_b.begin(), from_b.end(), x), 0);
}

TEST(ChoiceSource, AnExhaustedSourceAnswersTheSimplest) {
  const std::vector<std::uint32_t> words{5, 123456};
  ChoiceSource source = ChoiceSource::from_words(words);
  EXPECT_EQ(source.n(10), 5U);
  EXPECT_EQ(source.n(1000), 456U);
  EXPECT_EQ(source.n(10), 0U);
  EXPECT_EQ(source.zigzag(7), 0);
  EXPECT_FALSE(source.coin());
  EXPECT_FALSE(source.one_in(4));
  EXPECT_EQ(source.range(-3, 9), -3);
  EXPECT_EQ(source.signed_real(), 0.0);
}

TEST(ChoiceSource, AQuestionWithOneAnswerCostsNothing) {
  const std::vector<std::uint32_t> words{5};
  ChoiceSource source = ChoiceSource::from_words(words);
  EXPECT_EQ(source.n(1), 0U);
  EXPECT_EQ(source.n(10), 5U);
}

TEST(ChoiceSource, BytesAreTakenAsSparinglyAsTheQuestionAllows) {
  const std::vector<std::uint8_t> bytes{7, 0x01, 0x02, 9};
  ChoiceSource source = ChoiceSource::from_bytes(bytes);
  EXPECT_EQ(source.n(256), 7U);        // one byte
  EXPECT_EQ(source.n(65536), 0x102U);  // two
  EXPECT_EQ(source.n(1 << 20), 9U);    // four wanted, one there
  EXPECT_EQ(source.n(256), 0U);
}

TEST(ChoiceSource, ZigzagCountsOutFromZero) {
  const std::vector<std::uint32_t> words{0, 1, 2, 3, 4, 5, 6};
  ChoiceSource source = ChoiceSource::from_words(words);
  for (const std::int64_t expected : {0, 1, -1, 2, -2, 3, -3}) EXPECT_EQ(source.zigzag(3), expected);
}

TEST(ChoiceSource, EveryAnswerComesAboutAsOften) {
  ChoiceSource source = ChoiceSource::from_seed(3);
  std::array<int, 10> seen{};
  for (int i = 0; i < 100000; ++i) ++seen[source.n(10)];
  for (const int count : seen) EXPECT_NEAR(count, 10000, 500);  // 5 standard deviations
}

TEST(ChoiceSource, RealsFillTheirInterval) {
  ChoiceSource source = ChoiceSource::from_seed(5);
  double low = 1, high = -1, sum = 0;
  for (int i = 0; i < 100000; ++i) {
    const double x = source.signed_real();
    ASSERT_GT(x, -1);
    ASSERT_LT(x, 1);
    low = std::min(low, x);
    high = std::max(high, x);
    sum += x;
  }
  EXPECT_LT(low, -0.999);
  EXPECT_GT(high, 0.999);
  EXPECT_NEAR(sum / 100000, 0, 0.01);
}

}  // namespace
}  // namespace selvage::fuzz
