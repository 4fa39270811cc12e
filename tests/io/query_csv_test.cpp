#include "io/query_csv.h"

#include <gtest/gtest.h>

// gtest before RapidCheck's bridge
#include <cmath>

#include <rapidcheck/gtest.h>

#include "io/file/rational.h"
#include "tests/io/random_doubles.h"
#include "tests/io/support.h"
#include "tests/property.h"

namespace selvage::io {
namespace {

using testing::check_property;
using testing::expect_error;

/// Product of a decimal number and a digit, as on paper.
std::string times(const std::string& decimal, int factor) {
  std::string product;
  int carry = 0;
  for (auto digit = decimal.rbegin(); digit != decimal.rend(); ++digit) {
    carry += (*digit - '0') * factor;
    product.insert(product.begin(), static_cast<char>('0' + carry % 10));
    carry /= 10;
  }
  return carry == 0 ? product : std::to_string(carry) + product;
}

std::string times_power_of_two(std::string decimal, int exponent) {
  while (exponent-- > 0) decimal = times(decimal, 2);
  return decimal;
}

/// |value| = integer * 2^exponent, as numerator and denominator.
std::pair<std::string, std::string> rational_of(double value) {
  int exponent = 0;
  const double mantissa = std::ldexp(std::frexp(std::abs(value), &exponent), 53);
  exponent -= 53;
  const std::string integer = std::to_string(static_cast<std::uint64_t>(mantissa));
  return {times_power_of_two(integer, exponent), times_power_of_two("1", -exponent)};
}

double rational(const std::string& n, const std::string& d) {
  double value = -7;
  EXPECT_EQ(parse_rational(n, d, value), RationalFault::kNone) << n << " / " << d;
  return value;
}
RationalFault fault(const std::string& n, const std::string& d) {
  double value = -7;
  return parse_rational(n, d, value);
}

TEST(Rational, prop_every_double_comes_back) {
  check_property(300, 6, [] {
    const double value = *testing::finite_double();
    auto [numerator, denominator] = rational_of(value);
    const int factor = *rc::gen::inRange(1, 8);  // not in lowest terms
    if (std::signbit(value)) numerator.insert(0, 1, '-');
    const std::string sign = numerator[0] == '-' ? "-" : "";
    const double read = rational(sign + times(numerator.substr(sign.size()), factor), times(denominator, factor));
    RC_ASSERT(read == value);
    RC_ASSERT(value != 0 || !std::signbit(read));
  });
}

TEST(Rational, prop_the_middle_between_two_doubles_is_refused) {
  check_property(300, 7, [] {
    const double value = std::abs(*testing::finite_double());
    RC_PRE(std::isnormal(value));
    int exponent = 0;
    const auto mantissa = static_cast<std::uint64_t>(std::ldexp(std::frexp(value, &exponent), 53));
    const std::string middle = std::to_string(2 * mantissa + 1);
    exponent -= 54;
    RC_ASSERT(fault(times_power_of_two(middle, exponent), times_power_of_two("1", -exponent)) ==
              RationalFault::kNotDouble);
  });
}

TEST(Rational, EdgesOfTheDoubles) {
  const auto power = [](int exponent) { return times_power_of_two("1", exponent); };
  EXPECT_EQ(rational("1", power(1074)), 0x1p-1074);
  EXPECT_EQ(rational("3", power(1074)), 0x3p-1074);
  EXPECT_EQ(fault("1", power(1075)), RationalFault::kNotDouble) << "half the smallest";
  EXPECT_EQ(fault("3", power(1075)), RationalFault::kNotDouble);
  EXPECT_EQ(rational(power(1023), "1"), 0x1p1023);
  EXPECT_EQ(fault(power(1024), "1"), RationalFault::kNotDouble);
  EXPECT_EQ(rational(power(2000), power(1990)), 1024.0);
  EXPECT_EQ(fault("1", "3"), RationalFault::kNotDouble);
  EXPECT_EQ(fault("1", "10"), RationalFault::kNotDouble);
  EXPECT_EQ(rational("-3", "6"), -0.5);
  EXPECT_EQ(rational("+0000000", "7"), 0.0);
  EXPECT_FALSE(std::signbit(rational("-0", "1")));
}

TEST(Rational, WhatIsNoRational) {
  for (const char* bad : {"", "-", "+", "--1", "1.0", "1e3", "0x1", " 1", "1 ", "a", "\xd9\xa1"}) {
    EXPECT_EQ(fault(bad, "1"), RationalFault::kSyntax) << bad;
    EXPECT_EQ(fault("1", bad), RationalFault::kSyntax) << bad;
  }
  EXPECT_EQ(fault("1", "-1"), RationalFault::kSyntax);
  EXPECT_EQ(fault("1", "0"), RationalFault::kZeroDenominator);
  EXPECT_EQ(fault("0", "0"), RationalFault::kZeroDenominator);
  EXPECT_EQ(rational(std::string(kMaxDigits - 1, '0') + "1", "1"), 1.0);
  const std::string long_one = std::string(kMaxDigits, '0') + "1";
  EXPECT_EQ(fault(long_one, "1"), RationalFault::kManyDigits);
  EXPECT_EQ(fault("1", long_one), RationalFault::kManyDigits);
  EXPECT_EQ(fault(long_one + "a", "1"), RationalFault::kSyntax);
}

TEST(QueryCsv, RowsBecomePointsInOrder) {
  std::string text;
  for (int query = 0; query < 2; ++query) {
    for (int row = 0; row < 8; ++row) text += std::to_string(row) + ",2, -1 ,4,7,1," + std::to_string(query) + "\r\n";
  }
  const std::vector<CcdQuery> queries = parse_query_csv(text, "a.csv");
  ASSERT_EQ(queries.size(), 2u);
  EXPECT_EQ(queries[0].truth, false);
  EXPECT_EQ(queries[1].truth, true);
  for (std::size_t row = 0; row < 8; ++row) {
    EXPECT_EQ(queries[1].points[row], (std::array<double, 3>{0.5 * static_cast<double>(row), -0.25, 7.0}));
  }
}

TEST(QueryCsv, ColumnsAndRowsAreCounted) {
  const auto rows = [](int count, const std::string& row) {
    std::string text;
    for (int i = 0; i < count; ++i) text += row + "\n";
    return text;
  };
  const std::string six = "1,1,2,1,3,1", seven = six + ",0";
  EXPECT_FALSE(parse_query_csv(rows(8, six), "a.csv")[0].truth.has_value());
  const auto expect_bad = [](const std::string& fragment, const std::string& text) {
    expect_error(ErrorKind::kBadInput, fragment, [&] { (void)parse_query_csv(text, "a.csv"); });
  };
  expect_bad("a.csv:1: a row has three rationals", rows(8, "1,1,2,1,3"));
  expect_bad("a.csv:1: a row has three rationals", rows(8, seven + ",0"));
  expect_bad("a.csv:9: a row has three rationals", rows(8, seven) + rows(8, six));
  expect_bad("a.csv:8: the truth differs", rows(7, seven) + six + ",1\n");
  expect_bad("a.csv:1: the truth is '2'", rows(8, six + ",2"));
  expect_bad("a.csv:7: the last query has 7 of its 8 rows", rows(7, six));
  expect_bad("a.csv:9: a row has three rationals", rows(8, six) + "\n");
}

TEST(QueryCsv, ALastDenominatorThatMayBeCutIsRefused) {
  const auto query = [](const std::string& last) {
    std::string text;
    for (int i = 0; i < 7; ++i) text += "1,1,2,1,3,1\n";
    return text + "1,1,2,1,3," + last;
  };
  for (const char* cut : {"1", "4", "32"}) {
    expect_error(ErrorKind::kBadInput, "a.csv:8: the last line has no end and its number may be cut",
                 [&] { (void)parse_query_csv(query(cut), "a.csv"); });
    for (const char* end : {"\n", "\r\n", "\r", " "}) {
      EXPECT_EQ(parse_query_csv(query(cut) + end, "a.csv")[0].points[7][2], 3 / std::stod(cut));
    }
  }
  // These digits begin no other power of two. A truth is one digit.
  EXPECT_EQ(parse_query_csv(query("18014398509481984"), "a.csv")[0].points[7][2], std::ldexp(3, -54));
  std::string seven;
  for (int i = 0; i < 8; ++i) seven += std::string(i == 0 ? "" : "\n") + "1,1,2,1,3,1,0";
  EXPECT_EQ(parse_query_csv(seven, "a.csv")[0].truth, false);
}

}  // namespace
}  // namespace selvage::io
