// Columns of contact packs in SIMD lanes: as many of the eight values as a vector holds, from the lane `first` on.
#if defined(SELVAGE_SIM_PACK_COLUMNS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SELVAGE_SIM_PACK_COLUMNS_INL_H
#undef SELVAGE_SIM_PACK_COLUMNS_INL_H
#else
#define SELVAGE_SIM_PACK_COLUMNS_INL_H
#endif

#include <type_traits>

#include <hwy/highway.h>

#include "sim/dynamics/contact_pack.h"
#include "sim/response/friction_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace selvage::sim::HWY_NAMESPACE {

HWY_INLINE std::size_t VectorLanes() { return hn::Lanes(Real()); }
HWY_INLINE Truth TruthOf(LaneMask which, std::size_t first) {
  const std::uint8_t bits[8] = {static_cast<std::uint8_t>(which >> first)};  // as many are read
  return hn::LoadMaskBits(Real(), bits);
}
HWY_INLINE LaneMask LanesOf(Truth truth, std::size_t first) {
  std::uint8_t bits[8] = {};
  hn::StoreMaskBits(Real(), truth, bits);
  const auto all = static_cast<LaneMask>((1U << VectorLanes()) - 1);
  return static_cast<LaneMask>((bits[0] & all) << first);
}

HWY_INLINE Value Read(const LaneColumn<double>& column, std::size_t first) { return hn::LoadU(Real(), &column[first]); }
HWY_INLINE Vector Read(const LaneColumn3& columns, std::size_t first) {
  return {Read(columns[0], first), Read(columns[1], first), Read(columns[2], first)};
}
template <class Columns>
HWY_INLINE auto ReadFour(const Columns& columns, std::size_t first) {
  return std::array{Read(columns[0], first), Read(columns[1], first), Read(columns[2], first), Read(columns[3], first)};
}
HWY_INLINE void Write(Value value, std::size_t first, LaneColumn<double>& column) {
  hn::StoreU(value, Real(), &column[first]);
}
HWY_INLINE void Write(const Vector& value, std::size_t first, LaneColumn3& columns) {
  Write(value.x, first, columns[0]);
  Write(value.y, first, columns[1]);
  Write(value.z, first, columns[2]);
}
template <class T, class Column>
HWY_INLINE void WriteWhere(Truth which, const T& value, std::size_t first, Column& column) {
  if constexpr (std::is_same_v<T, Vector>) {
    Write(lanes::Choose<Real>(which, value, Read(column, first)), first, column);
  } else {
    Write(hn::IfThenElse(which, value, Read(column, first)), first, column);
  }
}

}  // namespace selvage::sim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
