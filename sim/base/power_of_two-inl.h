// power_of_two_above() in SIMD lanes.
#if defined(SELVAGE_SIM_POWER_OF_TWO_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SELVAGE_SIM_POWER_OF_TWO_INL_H
#undef SELVAGE_SIM_POWER_OF_TWO_INL_H
#else
#define SELVAGE_SIM_POWER_OF_TWO_INL_H
#endif

#include <hwy/highway.h>

#include "sim/base/power_of_two.h"

HWY_BEFORE_NAMESPACE();
namespace selvage::sim::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// The power whose biased exponent is one more.
template <class D>
HWY_INLINE hn::Vec<D> PowerOfTwoAbove(hn::Vec<D> length) {
  const hn::RebindToSigned<D> bits;
  const auto least = hn::BitCast(bits, hn::Set(D(), power_of_two_above(0)));
  const auto exponent = hn::ShiftRight<52>(hn::BitCast(bits, length));
  const auto above = hn::ShiftLeft<52>(hn::Add(exponent, hn::Set(bits, 1)));
  return hn::BitCast(D(), hn::IfThenElse(hn::Gt(above, least), above, least));
}

}  // namespace selvage::sim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
