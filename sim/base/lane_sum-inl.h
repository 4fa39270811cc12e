// Sums over rows in SIMD lanes (Highway).
#if defined(SELVAGE_SIM_LANE_SUM_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SELVAGE_SIM_LANE_SUM_INL_H
#undef SELVAGE_SIM_LANE_SUM_INL_H
#else
#define SELVAGE_SIM_LANE_SUM_INL_H
#endif

#include <hwy/highway.h>

#include "sim/base/lane_table-inl.h"

HWY_BEFORE_NAMESPACE();
namespace selvage::sim::HWY_NAMESPACE {

/// One for each lane of a block, added up last: the bits do not depend on how many lanes the vector unit has.
class LaneSum {
 public:
  HWY_INLINE void Add(Eigen::Index row, Value value) {
    double* const lanes = by_lane_ + row % kLanes;
    hn::StoreU(hn::Add(hn::LoadU(Real(), lanes), value), Real(), lanes);
  }
  [[nodiscard]] double total() const {
    double sum = 0;
    for (const double lane : by_lane_) sum += lane;
    return sum;
  }

 private:
  double by_lane_[kLanes] = {};
};

}  // namespace selvage::sim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
