// Loops over the entries of a lane table, for as many vertices at once as a vector holds (Highway; see
// kernel/lanes/lane_vector-inl.h for what makes all targets compute the same bits).
#if defined(SELVAGE_SIM_LANE_TABLE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SELVAGE_SIM_LANE_TABLE_INL_H
#undef SELVAGE_SIM_LANE_TABLE_INL_H
#else
#define SELVAGE_SIM_LANE_TABLE_INL_H
#endif

#include <hwy/highway.h>

#include "kernel/lanes/lane_vector-inl.h"
#include "sim/base/lane_table.h"

HWY_BEFORE_NAMESPACE();
namespace selvage::sim::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
namespace lanes = selvage::detail::HWY_NAMESPACE;

using Real = hn::CappedTag<double, kLanes>;
using Value = hn::Vec<Real>;
using Vector = lanes::Value3<Real>;

/// Both kinds of slots visit: without this one of the two is a call, with vectors in memory.
#define SELVAGE_INLINE_LAMBDA __attribute__((always_inline))

/// Vertices in a vector.
HWY_INLINE Eigen::Index VectorRows() { return static_cast<Eigen::Index>(hn::Lanes(Real())); }

/// The axes of vectors, at hand.
struct Axes {
  Axes(const double* of_x, const double* of_y, const double* of_z) : x(of_x), y(of_y), z(of_z) {}
  explicit Axes(const LaneVectors& vectors) : Axes(vectors.axis(0), vectors.axis(1), vectors.axis(2)) {}
  const double *x, *y, *z;
};
HWY_INLINE Vector ReadRows(const Axes& from, Eigen::Index first) {
  const Real d;
  return {hn::LoadU(d, from.x + first), hn::LoadU(d, from.y + first), hn::LoadU(d, from.z + first)};
}
HWY_INLINE Vector GatherRows(const Axes& from, const std::int32_t* rows) {
  const Real d;
  const auto place = hn::PromoteTo(hn::RebindToSigned<Real>(), hn::LoadU(hn::Rebind<std::int32_t, Real>(), rows));
  return {hn::GatherIndex(d, from.x, place), hn::GatherIndex(d, from.y, place), hn::GatherIndex(d, from.z, place)};
}
HWY_INLINE void WriteRows(const Vector& value, LaneVectors& to, Eigen::Index first) {
  const Real d;
  hn::StoreU(value.x, d, to.axis(0) + first);
  hn::StoreU(value.y, d, to.axis(1) + first);
  hn::StoreU(value.z, d, to.axis(2) + first);
}
HWY_INLINE Vector ZeroRows() { return {hn::Zero(Real()), hn::Zero(Real()), hn::Zero(Real())}; }
HWY_INLINE Value ReadEntries(const std::vector<double>& column, std::size_t entry) {
  return hn::LoadU(Real(), column.data() + entry);
}

/// Calls visit(entry, read) for every slot of the vertices from `row` on; read(axes) are the neighbours' rows.
template <class Visit>
HWY_INLINE void ForEachSlot(const LaneTable& table, Eigen::Index row, Visit visit) {
  const auto block = static_cast<std::size_t>(row / kLanes), lane = static_cast<std::size_t>(row % kLanes);
  std::size_t slot = table.begin[block];
  for (; slot < table.run_end[block]; ++slot) {
    const Eigen::Index first = table.first[slot] + static_cast<Eigen::Index>(lane);
    visit(kLanes * slot + lane, [first](const Axes& from) HWY_ATTR { return ReadRows(from, first); });
  }
  for (; slot < table.begin[block + 1]; ++slot) {
    const std::int32_t* const rows = &table.neighbour[kLanes * slot + lane];
    visit(kLanes * slot + lane, [rows](const Axes& from) HWY_ATTR { return GatherRows(from, rows); });
  }
}

}  // namespace selvage::sim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
