#include "verify/arithmetic/dyadic.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <stdexcept>

namespace selvage::verify {
namespace {

constexpr int kFractionBits = 52;
constexpr std::uint64_t kFractionMask = (std::uint64_t{1} << kFractionBits) - 1;
constexpr int kExponentBias = 1075;       // of the mantissa read as an integer
constexpr int kSmallestExponent = -1074;  // the unit of the subnormals

/// The double mantissa * 2^exponent, from its bits. REQUIRES exponent >= -1074 and mantissa <= 2^53, and where the
/// exponent is larger mantissa >= 2^52. The hidden bit, or a carry to 2^53, adds one to the exponent field by itself.
double from_bits(std::uint64_t mantissa, long exponent) {
  return std::bit_cast<double>((static_cast<std::uint64_t>(exponent - kSmallestExponent) << kFractionBits) + mantissa);
}

double round_towards(const mpz_class& numerator, unsigned long log2_denominator, bool up) {
  if (numerator == 0) return 0;
  const auto bits = static_cast<long>(mpz_sizeinbase(numerator.get_mpz_t(), 2));
  const auto scale = static_cast<long>(log2_denominator);
  // The exponent of the last bit kept: 53 bits, or fewer in the subnormal range.
  const long exponent = std::max(bits - (kFractionBits + 1) - scale, static_cast<long>(kSmallestExponent));
  const long shift = exponent + scale;
  mpz_class kept = numerator;
  if (shift <= 0) {
    kept <<= static_cast<unsigned long>(-shift);
  } else if (up) {
    mpz_cdiv_q_2exp(kept.get_mpz_t(), numerator.get_mpz_t(), static_cast<unsigned long>(shift));
  } else {
    kept >>= static_cast<unsigned long>(shift);
  }
  return from_bits(kept.get_ui(), exponent);
}

}  // namespace

static_assert(std::numeric_limits<unsigned long>::digits == 64, "mpz_class::get_ui must hold 53 bits");

Dyadic to_dyadic(double x) {
  const auto bits = std::bit_cast<std::uint64_t>(x);
  const int biased = static_cast<int>((bits >> kFractionBits) & 0x7ff);
  if (biased == 0x7ff) throw std::invalid_argument("exact arithmetic needs finite coordinates");
  std::uint64_t mantissa = bits & kFractionMask;
  int exponent = kSmallestExponent;
  if (biased != 0) {
    mantissa |= kFractionMask + 1;
    exponent = biased - kExponentBias;
  }
  if (mantissa == 0) return {};
  const int trailing = std::countr_zero(mantissa);
  const auto magnitude = static_cast<std::int64_t>(mantissa >> trailing);
  return {(bits >> 63) != 0 ? -magnitude : magnitude, exponent + trailing};
}

int scale_to_integers(std::span<const double> values, std::span<mpz_class> integers) {
  int smallest = std::numeric_limits<int>::max();
  for (const double value : values) {
    const Dyadic dyadic = to_dyadic(value);
    if (dyadic.mantissa != 0) smallest = std::min(smallest, dyadic.exponent);
  }
  for (std::size_t i = 0; i < values.size(); ++i) {
    const Dyadic dyadic = to_dyadic(values[i]);
    integers[i] = static_cast<long>(dyadic.mantissa);
    if (dyadic.mantissa != 0) integers[i] <<= static_cast<unsigned long>(dyadic.exponent - smallest);
  }
  return smallest == std::numeric_limits<int>::max() ? 0 : -smallest;
}

double round_down(const mpz_class& numerator, unsigned long log2_denominator) {
  return round_towards(numerator, log2_denominator, false);
}
double round_up(const mpz_class& numerator, unsigned long log2_denominator) {
  return round_towards(numerator, log2_denominator, true);
}

}  // namespace selvage::verify
