#include "fuzz/base/short_numbers.h"

#include <bit>
#include <cmath>
#include <cstdint>

namespace selvage::fuzz {

int mantissa_bits(double x) {
  if (!std::isfinite(x)) return kNotFiniteBits;
  const std::uint64_t mantissa = std::bit_cast<std::uint64_t>(x) & ((std::uint64_t{1} << 52) - 1);
  return x == 0 ? 0 : mantissa == 0 ? 1 : 53 - std::countr_zero(mantissa);
}

double round_to_bits(double x, int bits) {
  if (x == 0 || !std::isfinite(x)) return x;
  int exponent = 0;
  const double fraction = std::frexp(x, &exponent);
  return std::ldexp(std::round(std::ldexp(fraction, bits)), exponent - bits);
}

}  // namespace selvage::fuzz
