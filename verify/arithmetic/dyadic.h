// Finite doubles as integers: every one is mantissa * 2^exponent, so a common power of two makes a set of them whole.
// Works on the bits alone, so flush-to-zero, denormals-are-zero and the rounding mode do not matter.
#pragma once

#include <cstdint>
#include <span>

#include <gmpxx.h>

namespace selvage::verify {

/// x = mantissa * 2^exponent with an odd mantissa; zero is 0 * 2^0.
struct Dyadic {
  std::int64_t mantissa = 0;
  int exponent = 0;
};
/// Throws std::invalid_argument where x is not finite.
[[nodiscard]] Dyadic to_dyadic(double x);

/// integers[i] = values[i] * 2^k for one k, the smallest for which all are whole; returns k (0 if all values are zero).
/// REQUIRES equal sizes. Throws std::invalid_argument where a value is not finite.
int scale_to_integers(std::span<const double> values, std::span<mpz_class> integers);

/// The largest double <= numerator / 2^log2_denominator, and the smallest >= it. REQUIRES a value in [0, 1].
[[nodiscard]] double round_down(const mpz_class& numerator, unsigned long log2_denominator);
[[nodiscard]] double round_up(const mpz_class& numerator, unsigned long log2_denominator);

}  // namespace selvage::verify
