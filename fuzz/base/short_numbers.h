// What makes a number simple: few bits. Shared by the shrinkers.
#pragma once

#include <array>

namespace selvage::fuzz {

/// Lengths to round to, the shortest first.
inline constexpr std::array<int, 12> kShortBits{1, 2, 3, 4, 6, 8, 12, 16, 20, 24, 32, 40};

/// What is no number has a cost of its own: a candidate that must be refused should keep one of them at most.
inline constexpr int kNotFiniteBits = 64;

/// Bits of the mantissa up to the last that is set; 0 for 0, kNotFiniteBits for what is not finite.
[[nodiscard]] int mantissa_bits(double x);
/// To so many bits; ties away from zero. What is not finite stays as it is.
[[nodiscard]] double round_to_bits(double x, int bits);

}  // namespace selvage::fuzz
