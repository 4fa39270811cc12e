// The probes stand in a unit of their own, and read volatile operands, so that the compiler computes none of them.
#include <limits>

#include "kernel/fp_env.h"

namespace selvage {

namespace {

unsigned rounding_defect() {
  // 1 + 2^-53 is a tie: to even gives 1. Upward gives more; downward and toward zero show in 1 + 3 * 2^-54.
  const volatile double one = 1, tie = 0x1p-53, above_tie = 0x3p-54;
  const volatile double at_tie = one + tie, above = one + above_tie, below = -one - tie;
  return at_tie == 1 && above == 1 + 0x1p-52 && below == -1 ? 0U : kFpRounding;
}

unsigned subnormal_defects() {
  const volatile double least_normal = std::numeric_limits<double>::min(), half = 0.5, huge = 0x1p+1000;
  const volatile double subnormal = std::numeric_limits<double>::denorm_min();
  const volatile double made = least_normal * half, used = subnormal * huge;
  // A flushed result compares equal to zero; so does a subnormal operand under DAZ, hence the detour over its bits.
  const volatile double restored = made * huge;
  const bool flushes = __builtin_bit_cast(unsigned long long, static_cast<double>(made)) == 0;
  const bool ignores = used == 0 || (!flushes && restored == 0);
  return (flushes ? kFpFlush : 0U) | (ignores ? kFpDenormals : 0U);
}

unsigned contraction_defect() {
  // (1 + 2^-27)^2 = 1 + 2^-26 + 2^-54: rounded it loses 2^-54, fused it keeps it.
  const volatile double factor = 1 + 0x1p-27, addend = -(1 + 0x1p-26);
  const double a = factor, c = addend;
  const volatile double result = a * a + c;
  return result == 0 ? 0U : kFpContracted;
}

unsigned comparison_defects() {
  const volatile double zero = 0, one = 1;
  const double nan = zero / zero, infinity = one / zero;
  const bool nan_works = nan != nan && !(nan < one) && !(nan > one) && !(nan == nan);
  const bool infinity_works = infinity > std::numeric_limits<double>::max() && -infinity < zero && infinity == infinity;
  return (nan_works ? 0U : kFpNan) | (infinity_works ? 0U : kFpInfinity);
}

unsigned excess_defect() {
  const volatile double one = 1, tiny = 0x1p-60, big = 0x1p+53, two = 2;
  const double a = one, b = tiny, c = big, d = two;
  const volatile double reassociated = (a + b) - a;  // 0, unless regrouped or kept in a wider register
  const volatile double wide = (c + a) - c;          // 0: 2^53 + 1 ties to even
  const volatile double grouped = (c + d) - c;
  return reassociated == 0 && wide == 0 && grouped == 2 ? 0U : kFpExcess;
}

}  // namespace

unsigned fp_env_defects() noexcept {
  return rounding_defect() | subnormal_defects() | contraction_defect() | comparison_defects() | excess_defect();
}

}  // namespace selvage
