// Decimal rationals that are exactly doubles, as the public query sets write them.
#pragma once

#include <cstddef>
#include <string_view>

namespace selvage::io {

enum class RationalFault {
  kNone,
  kSyntax,      ///< no integer over a positive integer
  kManyDigits,  ///< more than kMaxDigits in one of them
  kZeroDenominator,
  kNotDouble,  ///< between two doubles, or beyond the largest
};

/// Digits of numerator and denominator; the doubles themselves need at most 767.
inline constexpr std::size_t kMaxDigits = 2048;

/// The double that is exactly numerator / denominator (not necessarily in lowest terms). No rounding anywhere.
[[nodiscard]] RationalFault parse_rational(std::string_view numerator, std::string_view denominator, double& value);

}  // namespace selvage::io
