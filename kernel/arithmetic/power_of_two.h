// Exact scaling by powers of two, for any pair of exponents that doubles can have.
#pragma once

#include <bit>
#include <cstdint>
#include <limits>

#include "kernel/arithmetic/vec3.h"

namespace selvage::detail {

/// 2^e, -1022 <= e <= 1023.
inline double power_of_two(int e) { return std::bit_cast<double>(static_cast<std::uint64_t>(e + 1023) << 52); }

/// The e with 2^(e-1) <= value < 2^e; value > 0 and finite.
inline int exponent_of(double value) {
  const auto bits = std::bit_cast<std::uint64_t>(value);
  const int biased = static_cast<int>(bits >> 52);
  return biased != 0 ? biased - 1022 : static_cast<int>(std::bit_width(bits)) - 1074;
}

/// value * 2^e, |e| <= 2000: exact, unless the result is subnormal (then wrong by at most 2^-1074) or infinite. In two
/// factors, because 2^e need not be a double.
inline double times_power(double value, int e) { return (value * power_of_two(e / 2)) * power_of_two(e - e / 2); }
inline DoubleDouble times_power(const DoubleDouble& value, int e) {
  return {times_power(value.hi, e), times_power(value.lo, e)};
}
template <class Real>
Triple<Real> times_power(const Triple<Real>& v, int e) {
  return {times_power(v.x, e), times_power(v.y, e), times_power(v.z, e)};
}

/// Never below value * 2^e.
inline double times_power_upper(double value, int e) {
  const double result = times_power(value, e);
  const bool inexact = value > 0 && result < std::numeric_limits<double>::min();
  return inexact ? result + std::numeric_limits<double>::denorm_min() : result;
}

/// Never above value * 2^e, nor below 0; value >= 0.
inline double times_power_lower(double value, int e) {
  const double result = times_power(value, e);
  const bool inexact = result > 0 && result <= std::numeric_limits<double>::min();  // to which a tie rounds up
  return inexact ? result - std::numeric_limits<double>::denorm_min() : result;
}

/// v * 2^k with the largest |component| (of the leading doubles) in [0.5, 1): a direction. Zero where v is zero or not
/// finite.
template <class Real>
Triple<Real> normalize_exponent(const Triple<Real>& v) {
  const double largest = max_component(abs(leading(v)));
  if (!(largest > 0) || largest == std::numeric_limits<double>::infinity()) return {};
  return times_power(v, -exponent_of(largest));
}

}  // namespace selvage::detail
