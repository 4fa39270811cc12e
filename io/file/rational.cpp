#include "io/file/rational.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace selvage::io {
namespace {

bool are_digits(std::string_view text) {
  return !text.empty() && std::ranges::all_of(text, [](char letter) { return letter >= '0' && letter <= '9'; });
}

/// A natural number as 32-bit digits, least significant first, without leading zeros.
class Natural {
 public:
  /// Of decimal digits.
  explicit Natural(std::string_view digits) {
    for (const char digit : digits) multiply_add(10, static_cast<std::uint32_t>(digit - '0'));
  }

  [[nodiscard]] bool is_zero() const { return limbs_.empty(); }
  [[nodiscard]] int bit_length() const {
    return is_zero() ? 0 : static_cast<int>(32 * limbs_.size()) - std::countl_zero(limbs_.back());
  }

  void shift_left(int bits) {
    if (is_zero()) return;
    limbs_.insert(limbs_.begin(), static_cast<std::size_t>(bits / 32), 0);
    multiply_add(std::uint32_t{1} << (bits % 32), 0);
  }
  /// REQUIRES other <= *this.
  void subtract(const Natural& other) {
    std::int64_t borrow = 0;
    for (std::size_t i = 0; i < limbs_.size(); ++i) {
      const std::int64_t digit = std::int64_t{limbs_[i]} - (i < other.limbs_.size() ? other.limbs_[i] : 0) + borrow;
      limbs_[i] = static_cast<std::uint32_t>(digit);
      borrow = digit < 0 ? -1 : 0;
    }
    while (!limbs_.empty() && limbs_.back() == 0) limbs_.pop_back();
  }
  friend bool operator<(const Natural& a, const Natural& b) {
    if (a.limbs_.size() != b.limbs_.size()) return a.limbs_.size() < b.limbs_.size();
    return std::lexicographical_compare(a.limbs_.rbegin(), a.limbs_.rend(), b.limbs_.rbegin(), b.limbs_.rend());
  }

 private:
  void multiply_add(std::uint32_t factor, std::uint32_t addend) {
    std::uint64_t carry = addend;
    for (std::uint32_t& limb : limbs_) {
      carry += std::uint64_t{limb} * factor;
      limb = static_cast<std::uint32_t>(carry);
      carry >>= 32;
    }
    if (carry != 0) limbs_.push_back(static_cast<std::uint32_t>(carry));
  }

  std::vector<std::uint32_t> limbs_;
};

/// n / d by long division in base 2. The quotient is mantissa * 2^exponent if at most 53 bits leave no remainder.
RationalFault divide(Natural n, Natural d, double& value) {
  if (n.is_zero()) {
    value = 0;
    return RationalFault::kNone;
  }
  // Scale so that 1 <= n / d < 2: the first bit of the quotient is then the one of weight 2^exponent.
  int exponent = n.bit_length() - d.bit_length();
  exponent >= 0 ? d.shift_left(exponent) : n.shift_left(-exponent);
  if (n < d) {
    n.shift_left(1);
    --exponent;
  }
  std::uint64_t mantissa = 0;
  int last_weight = exponent;  // of the last bit of the mantissa
  for (int bits = 0; bits < std::numeric_limits<double>::digits; ++bits) {
    if (bits > 0) {
      n.shift_left(1);
      mantissa <<= 1;
      --last_weight;
    }
    if (!(n < d)) {
      n.subtract(d);
      mantissa |= 1;
    }
    if (n.is_zero()) break;
  }
  constexpr int kSmallestWeight =
      std::numeric_limits<double>::min_exponent - std::numeric_limits<double>::digits;  // -1074
  if (!n.is_zero() || last_weight < kSmallestWeight || exponent >= std::numeric_limits<double>::max_exponent) {
    return RationalFault::kNotDouble;
  }
  value = std::ldexp(static_cast<double>(mantissa), last_weight);
  return RationalFault::kNone;
}

}  // namespace

RationalFault parse_rational(std::string_view numerator, std::string_view denominator, double& value) {
  const bool is_negative = numerator.starts_with('-');
  if (is_negative || numerator.starts_with('+')) numerator.remove_prefix(1);
  if (!are_digits(numerator) || !are_digits(denominator)) return RationalFault::kSyntax;
  if (std::max(numerator.size(), denominator.size()) > kMaxDigits) return RationalFault::kManyDigits;
  const Natural n(numerator), d(denominator);
  if (d.is_zero()) return RationalFault::kZeroDenominator;
  const RationalFault fault = divide(n, d, value);
  if (is_negative && value != 0) value = -value;
  return fault;
}

}  // namespace selvage::io
