#include "verify/search/box_block.h"

#include <algorithm>
#include <cmath>

namespace selvage::verify {
namespace {

constexpr double kLatticeMax = 0x1p30;

}  // namespace

Box bounding_box(std::span<const Point> points) {
  Box box{points[0], points[0]};
  for (const Point& p : points.subspan(1)) {
    for (std::size_t k = 0; k < 3; ++k) {
      box.min[k] = std::min(box.min[k], p[k]);
      box.max[k] = std::max(box.max[k], p[k]);
    }
  }
  return box;
}

Box grown(const Box& box, double distance) {
  constexpr double kLowest = std::numeric_limits<double>::lowest(), kLargest = std::numeric_limits<double>::max();
  Box larger = box;
  for (std::size_t k = 0; k < 3; ++k) {
    // A sum that overflows ends at the largest double: no finite coordinate lies beyond.
    larger.min[k] = std::nextafter(std::max(box.min[k] - distance, kLowest), kLowest);
    larger.max[k] = std::nextafter(std::min(box.max[k] + distance, kLargest), kLargest);
  }
  return larger;
}

// Every operation rounds monotonically, so their composition is non-decreasing whatever it loses. Halves keep the
// difference of two finite doubles finite.
std::int32_t Lattice::operator()(std::size_t axis, double x) const {
  const double position = (x * 0.5 - origin_half[axis]) * scale;
  return static_cast<std::int32_t>(std::clamp(position, -kLatticeMax, kLatticeMax));
}

Lattice Lattice::over(const Box& bounds) {
  Lattice lattice;
  double half_extent = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    lattice.origin_half[k] = bounds.min[k] * 0.25 + bounds.max[k] * 0.25;
    half_extent = std::max(half_extent, bounds.max[k] * 0.25 - bounds.min[k] * 0.25);
  }
  lattice.scale = std::min(kLatticeMax / half_extent, std::numeric_limits<double>::max());  // finite for extent 0
  return lattice;
}

BoxBlock::BoxBlock() {
  for (std::size_t k = 0; k < 3; ++k) {
    min[k].fill(std::numeric_limits<std::int32_t>::max());
    max[k].fill(std::numeric_limits<std::int32_t>::min());
  }
}

void BoxBlock::set(std::size_t place, const LatticeBox& box) {
  for (std::size_t k = 0; k < 3; ++k) {
    min[k][place] = box.min[k];
    max[k][place] = box.max[k];
  }
}

LatticeBox BoxBlock::get(std::size_t place) const {
  return {{min[0][place], min[1][place], min[2][place]}, {max[0][place], max[1][place], max[2][place]}};
}

LatticeBox BoxBlock::bounds() const {
  LatticeBox box{};
  for (std::size_t k = 0; k < 3; ++k) {
    box.min[k] = *std::min_element(min[k].begin(), min[k].end());
    box.max[k] = *std::max_element(max[k].begin(), max[k].end());
  }
  return box;
}

}  // namespace selvage::verify
