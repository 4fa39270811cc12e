#include "fuzz/oracle/accuracy.h"

#include <cmath>

#include <gtest/gtest.h>

#include "fuzz/oracle/closest_approach.h"

namespace selvage::fuzz {
namespace {

/// A point that moves from height `z_t0` to `z_t1` above the middle of a triangle of size 4.
MotionQuery above_a_triangle(double z_t0, double z_t1) {
  MotionQuery query;
  query.x_t0 = {Vec3(1, 1, z_t0), Vec3(0, 0, 0), Vec3(4, 0, 0), Vec3(0, 4, 0)};
  query.x_t1 = query.x_t0;
  query.x_t1[0].z() = z_t1;
  return query;
}

TEST(Accuracy, BinsHoldPowersOfTwoFromAbove) {
  EXPECT_EQ(bin_of(0), 0);
  EXPECT_EQ(bin_of(-1), 0);
  EXPECT_EQ(bin_of(7), 1);
  EXPECT_EQ(bin_of(1), 1);
  EXPECT_EQ(bin_of(0.5000001), 1);
  EXPECT_EQ(bin_of(0.5), 2);
  EXPECT_EQ(bin_of(0x1p-62), 63);
  EXPECT_EQ(bin_of(0x1p-1074), 63);
}

TEST(Accuracy, SpreadsAreBoundsFromAbove) {
  Accuracy::Histogram histogram{};
  EXPECT_EQ(spread_of(histogram).count, 0);
  for (int i = 0; i < 60; ++i) ++histogram[static_cast<std::size_t>(bin_of(0))];
  for (int i = 0; i < 35; ++i) ++histogram[static_cast<std::size_t>(bin_of(0.125))];
  for (int i = 0; i < 5; ++i) ++histogram[static_cast<std::size_t>(bin_of(0.4))];
  const Spread spread = spread_of(histogram);
  EXPECT_EQ(spread.count, 100);
  EXPECT_EQ(spread.half, 0);
  EXPECT_EQ(spread.nine_tenths, 0.125);
  EXPECT_EQ(spread.all_but_a_hundredth, 0.5);
  EXPECT_EQ(spread.worst, 0.5);
  EXPECT_DOUBLE_EQ(spread.mean, 0.35 * 0.125 + 0.05 * 0.5);
}

TEST(Accuracy, ATimeIsComparedWithTheFirstTouch) {
  const MotionQuery falls = above_a_triangle(1, -1);  // touches at t = 1/2
  const AccuracySample sample = measure_accuracy(falls, true, true, 0.25);
  EXPECT_EQ(sample.early_time, bin_of(0.25));
  EXPECT_EQ(sample.early_distance, bin_of(0.5 / 4));
  EXPECT_EQ(sample.gap, -1);
  EXPECT_EQ(measure_accuracy(falls, true, true, 0.5).early_time, bin_of(0));
  EXPECT_EQ(measure_accuracy(falls, true, true, std::nullopt).early_time, -1);
  EXPECT_EQ(measure_accuracy(falls, true, false, std::nullopt).early_time, -1);
}

// What moves along with the features takes no part of what is measured.
TEST(Accuracy, ADistanceIsThatOfTheFeaturesHoweverFarOutTheyGo) {
  MotionQuery falls = above_a_triangle(1, -2);
  for (std::size_t i = 0; i < 4; ++i) {
    falls.x_t0[i] += Vec3(0x1p40, -0x1p41, 3);
    falls.x_t1[i] += Vec3(-0x1p41, 0x1p40, 0x1p40);
  }
  EXPECT_NEAR(rounded_distance(falls, 0.3), 0.1, 1e-15);
}

TEST(Accuracy, ATimeBelowAnIrrationalTouchIsEarly) {
  MotionQuery query;  // the plane of the face turns as the point falls: the touch is at a root of 2
  query.x_t0 = {Vec3(0.25, 0.25, 1), Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
  query.x_t1 = {Vec3(0.25, 0.25, -1), Vec3(0, 0, 0), Vec3(2, 0, 1), Vec3(0, 1, 0)};
  const verify::ExactTime first = exact_motion(query, verify::Detail::kFirstTime).first;
  ASSERT_NE(first.lower, first.upper);
  const AccuracySample sample = measure_accuracy(query, true, true, first.lower_approx);
  EXPECT_GT(sample.early_time, bin_of(0));
  EXPECT_LE(sample.early_time, bin_of(0x1p-54));
}

TEST(Accuracy, AGapIsThatOfTheNearestApproach) {
  int expected = 0;
  for (const int exponent : {-5, -15, -25, -35, -45, -55}) {
    MotionQuery passes = above_a_triangle(1, -2);  // beside an edge, nearest inside the step, where no end shows it
    passes.x_t0[0].y() = passes.x_t1[0].y() = -std::ldexp(4, exponent);
    for (const bool alarm : {false, true}) {
      const AccuracySample sample = measure_accuracy(passes, false, alarm, std::nullopt);
      EXPECT_EQ(sample.gap, expected) << exponent;
      EXPECT_EQ(sample.alarm, alarm);
      EXPECT_EQ(sample.early_time, -1);
    }
    ++expected;
  }
}

TEST(Accuracy, SumsWhatWasMeasured) {
  Accuracy one, other;
  EXPECT_EQ(accuracy_text(one), "");
  one.add({});
  EXPECT_EQ(one, Accuracy());
  one.add({3, 4, -1, true});
  other.add({-1, -1, 5, true});
  other.add({-1, -1, 5, false});
  one += other;
  EXPECT_EQ(one.early_time[3], 1);
  EXPECT_EQ(one.early_distance[4], 1);
  EXPECT_EQ(one.apart, (Accuracy::ByGap{0, 0, 0, 0, 0, 2}));
  EXPECT_EQ(one.alarms, (Accuracy::ByGap{0, 0, 0, 0, 0, 1}));
  const std::string text = accuracy_text(one);
  EXPECT_NE(text.find("of 1 touches measured"), text.npos) << text;
  EXPECT_NE(text.find("    all                              0.25        0.125\n"), text.npos) << text;
  EXPECT_NE(text.find("    0, or not known                     2            1     50 %\n"), text.npos) << text;
}

}  // namespace
}  // namespace selvage::fuzz
