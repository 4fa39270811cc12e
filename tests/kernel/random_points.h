// Random queries for tests: the same bits for every compiler and standard library.
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

#include "kernel/arithmetic/vec3.h"

namespace selvage::testing {

/// SplitMix64 (Steele, Lea, Flood 2014).
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  std::uint64_t bits() {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15U);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
    return z ^ (z >> 31);
  }
  int integer(int first, int last) {
    return first + static_cast<int>(bits() % static_cast<std::uint64_t>(last - first + 1));
  }
  /// Uniform in [-1, 1), 53 bits.
  double uniform() { return static_cast<double>(static_cast<std::int64_t>(bits()) >> 11) * 0x1p-52; }
  /// Full significand, magnitude in [2^first, 2^last).
  double magnitude(int first, int last) {
    const double significand = 1 + static_cast<double>(bits() >> 12) * 0x1p-52;
    const int exponent = integer(first, last - 1);  // compilers evaluate arguments in different orders
    return std::ldexp((bits() & 1) != 0 ? significand : -significand, exponent);
  }
  bool chance(int one_in) { return integer(1, one_in) == 1; }

  detail::Double3 point() { return {uniform(), uniform(), uniform()}; }
  detail::Double3 point(int first, int last) {
    return {magnitude(first, last), magnitude(first, last), magnitude(first, last)};
  }

 private:
  std::uint64_t state_;
};

}  // namespace selvage::testing
