// Vectors in SIMD lanes: each component holds one value a lane. D is a Highway tag of doubles, of one lane or of many.
//   Only operations that round alike on every target, in the order in which they stand, and nothing fused, so that all
//   targets and all lane counts compute the same bits (K7).
#if defined(SELVAGE_KERNEL_LANE_VECTOR_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SELVAGE_KERNEL_LANE_VECTOR_INL_H
#undef SELVAGE_KERNEL_LANE_VECTOR_INL_H
#else
#define SELVAGE_KERNEL_LANE_VECTOR_INL_H
#endif

#include <hwy/highway.h>

#include "kernel/sound_arithmetic.h"

HWY_BEFORE_NAMESPACE();
namespace selvage::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

template <class D>
struct Value3 {
  hn::Vec<D> x, y, z;
};

template <class D>
HWY_INLINE Value3<D> Plus(const Value3<D>& a, const Value3<D>& b) {
  return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z)};
}
template <class D>
HWY_INLINE Value3<D> Minus(const Value3<D>& a, const Value3<D>& b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
template <class D>
HWY_INLINE Value3<D> Times(hn::Vec<D> s, const Value3<D>& a) {
  return {hn::Mul(s, a.x), hn::Mul(s, a.y), hn::Mul(s, a.z)};
}
/// Component by component.
template <class D>
HWY_INLINE Value3<D> Product(const Value3<D>& a, const Value3<D>& b) {
  return {hn::Mul(a.x, b.x), hn::Mul(a.y, b.y), hn::Mul(a.z, b.z)};
}
template <class D>
HWY_INLINE hn::Vec<D> Dot(const Value3<D>& a, const Value3<D>& b) {
  return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}
template <class D>
HWY_INLINE Value3<D> Cross(const Value3<D>& a, const Value3<D>& b) {
  return {hn::Sub(hn::Mul(a.y, b.z), hn::Mul(a.z, b.y)), hn::Sub(hn::Mul(a.z, b.x), hn::Mul(a.x, b.z)),
          hn::Sub(hn::Mul(a.x, b.y), hn::Mul(a.y, b.x))};
}
template <class D>
HWY_INLINE Value3<D> Absolute(const Value3<D>& a) {
  return {hn::Abs(a.x), hn::Abs(a.y), hn::Abs(a.z)};
}
template <class D>
HWY_INLINE Value3<D> Largest(const Value3<D>& a, const Value3<D>& b) {
  return {hn::Max(a.x, b.x), hn::Max(a.y, b.y), hn::Max(a.z, b.z)};
}
template <class D>
HWY_INLINE hn::Vec<D> SumOf(const Value3<D>& a) {
  return hn::Add(hn::Add(a.x, a.y), a.z);
}
template <class D>
HWY_INLINE Value3<D> Choose(hn::Mask<D> first, const Value3<D>& a, const Value3<D>& b) {
  return {hn::IfThenElse(first, a.x, b.x), hn::IfThenElse(first, a.y, b.y), hn::IfThenElse(first, a.z, b.z)};
}

}  // namespace selvage::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // SELVAGE_KERNEL_LANE_VECTOR_INL_H
