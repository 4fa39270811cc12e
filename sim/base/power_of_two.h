// Exact scaling by powers of two, so that squares and products stay in the range of doubles.
#pragma once

#include <algorithm>

#include "kernel/arithmetic/power_of_two.h"

namespace selvage::sim {

/// The least power of two above `length`, at least 2^-1000 so that dividing by it cannot overflow in the domain.
/// REQUIRES 0 <= length < 2^1023.
[[nodiscard]] inline double power_of_two_above(double length) {
  constexpr int kLeastExponent = -1000;
  return detail::power_of_two(length > 0 ? std::max(detail::exponent_of(length), kLeastExponent) : kLeastExponent);
}

}  // namespace selvage::sim
