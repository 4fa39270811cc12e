#include "sim/base/lane_vectors.h"

#include <algorithm>

#include "sim/base/parallel.h"

namespace selvage::sim {

void LaneScalars::copy(std::span<const double> values) {
  const Eigen::Index rows = std::ssize(values);
  column_.assign(static_cast<std::size_t>((rows + kLanes - 1) / kLanes * kLanes), 0);
  std::ranges::copy(values, column_.begin());
}

void LaneVectors::copy(const Positions& x) {
  resize(x.rows());
  parallel_each(rows_, [&](Eigen::Index i) { row(i) = x.row(i); });
}

void LaneVectors::copy_to(Positions& x) const {
  parallel_each(rows_, [&](Eigen::Index i) { x.row(i) = row(i); });
}

}  // namespace selvage::sim
