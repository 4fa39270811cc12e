#include "io/points.h"

#include <gtest/gtest.h>

// gtest before RapidCheck's bridge
#include <cmath>
#include <limits>

#include <rapidcheck/gtest.h>

#include "tests/io/random_doubles.h"
#include "tests/io/support.h"
#include "tests/property.h"

namespace selvage::io {
namespace {

using testing::expect_error;

constexpr double kLargest = static_cast<double>(std::numeric_limits<float>::max());

/// Any double that may become a float: of every exponent down to the subnormal floats and below.
rc::Gen<double> double_in_float_range() {
  return rc::gen::map(rc::gen::tuple(testing::finite_double(), rc::gen::inRange(-160, 128)), [](const auto& drawn) {
    const auto& [value, exponent] = drawn;
    int ignored = 0;
    const double x = std::ldexp(std::frexp(value, &ignored), exponent);
    return std::abs(x) <= kLargest ? x : kLargest;
  });
}

TEST(Points, prop_rounding_gives_the_nearest_float) {
  testing::check_property(2000, 1, [] {
    const double x = *double_in_float_range();
    Points points = {{x, 0, x}};
    Rounding rounding;
    round_to_float32(points, rounding, "in");
    const double rounded = points[0][0];
    const auto as_float = static_cast<float>(rounded);
    RC_ASSERT(static_cast<double>(as_float) == rounded);
    const double change = std::abs(rounded - x);
    for (const float towards : {-HUGE_VALF, HUGE_VALF}) {
      RC_ASSERT(!(std::abs(static_cast<double>(std::nextafter(as_float, towards)) - x) < change));
    }
    RC_ASSERT(std::signbit(rounded) == std::signbit(x));
    RC_ASSERT(rounding.values == 3);
    RC_ASSERT(rounding.changed == (change > 0 ? 2 : 0));
    RC_ASSERT(rounding.largest_change == change);
  });
}

TEST(Points, WhatRoundsToInfinityIsRefused) {
  const double tie = 0x1.ffffffp+127;  // halfway between the largest float and 2^128
  Points points = {{0, 0, 0}, {0, -std::nextafter(tie, 0.0), 0}};
  Rounding rounding;
  round_to_float32(points, rounding, "in");
  EXPECT_EQ(points[1][1], -kLargest);
  for (const double beyond : {tie, -tie, std::numeric_limits<double>::max()}) {
    points[1][1] = beyond;
    expect_error(ErrorKind::kBadInput, "in: vertex 1 is beyond the range of float32",
                 [&] { round_to_float32(points, rounding, "in"); });
  }
}

TEST(Points, RoundingAddsUp) {
  Rounding rounding;
  Points first = {{0.1, 1, 2}}, second = {{3, 0.3, 0x1p-200}};
  round_to_float32(first, rounding, "in");
  round_to_float32(second, rounding, "in");
  EXPECT_EQ(rounding.values, 6);
  EXPECT_EQ(rounding.changed, 3);
  EXPECT_EQ(rounding.largest_change, std::abs(static_cast<double>(0.3f) - 0.3));
}

}  // namespace
}  // namespace selvage::io
