#include "sim/base/points.h"

#include <cstring>

namespace selvage::sim {

io::Points points_of(const Positions& x) {
  io::Points points;
  points.reserve(static_cast<std::size_t>(x.rows()));
  for (Eigen::Index i = 0; i < x.rows(); ++i) points.push_back({x(i, 0), x(i, 1), x(i, 2)});
  return points;
}

bool same_bits(const Positions& a, const Positions& b) {
  return a.rows() == b.rows() &&
         std::memcmp(a.data(), b.data(), static_cast<std::size_t>(a.size()) * sizeof(double)) == 0;
}

}  // namespace selvage::sim
