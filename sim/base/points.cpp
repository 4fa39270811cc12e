#include "sim/base/points.h"

#include <cmath>
#include <cstring>

#include <fmt/format.h>

#include "io/error.h"

namespace selvage::sim {

io::Points points_of(const Positions& x) {
  io::Points points;
  points.reserve(static_cast<std::size_t>(x.rows()));
  for (Eigen::Index i = 0; i < x.rows(); ++i) points.push_back({x(i, 0), x(i, 1), x(i, 2)});
  return points;
}

void require_in_domain(const io::Points& points, const std::string& name) {
  for (std::size_t vertex = 0; vertex < points.size(); ++vertex) {
    for (const double x : points[vertex]) {
      if (std::abs(x) <= kMaxCoordinate) continue;
      throw io::Error(io::ErrorKind::kBadInput,
                      fmt::format("{}: vertex {} has the coordinate {:g}, beyond {:g}, which is the largest that the "
                                  "kernel takes; choose a larger unit of length",
                                  name, vertex, x, kMaxCoordinate));
    }
  }
}

bool same_bits(const Positions& a, const Positions& b) {
  return a.rows() == b.rows() &&
         std::memcmp(a.data(), b.data(), static_cast<std::size_t>(a.size()) * sizeof(double)) == 0;
}

}  // namespace selvage::sim
