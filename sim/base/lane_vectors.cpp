#include "sim/base/lane_vectors.h"

#include "sim/base/parallel.h"

namespace selvage::sim {

void LaneVectors::copy(const Positions& x) {
  resize(x.rows());
  parallel_each(rows_, [&](Eigen::Index i) { row(i) = x.row(i); });
}

void LaneVectors::copy_to(Positions& x) const {
  parallel_each(rows_, [&](Eigen::Index i) { x.row(i) = row(i); });
}

}  // namespace selvage::sim
