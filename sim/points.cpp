#include "sim/points.h"

namespace selvage::sim {

io::Points points_of(const Positions& x) {
  io::Points points;
  points.reserve(static_cast<std::size_t>(x.rows()));
  for (Eigen::Index i = 0; i < x.rows(); ++i) points.push_back({x(i, 0), x(i, 1), x(i, 2)});
  return points;
}

}  // namespace selvage::sim
