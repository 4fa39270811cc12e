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

template <std::size_t kInstants>
LatticeBoxes<kInstants> on_lattices(const Lattices<kInstants>& lattices, const Boxes<kInstants>& boxes) {
  LatticeBoxes<kInstants> result{};
  for (std::size_t i = 0; i < kInstants; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      result[i].min[k] = lattices[i](k, boxes[i].min[k]);
      result[i].max[k] = lattices[i](k, boxes[i].max[k]);
    }
  }
  return result;
}

template <std::size_t kInstants>
BoxBlock<kInstants>::BoxBlock() {
  for (std::size_t i = 0; i < kInstants; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      min[i][k].fill(std::numeric_limits<std::int32_t>::max());
      max[i][k].fill(std::numeric_limits<std::int32_t>::min());
    }
  }
}

template <std::size_t kInstants>
void BoxBlock<kInstants>::set(std::size_t place, const LatticeBoxes<kInstants>& boxes) {
  for (std::size_t i = 0; i < kInstants; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      min[i][k][place] = boxes[i].min[k];
      max[i][k][place] = boxes[i].max[k];
    }
  }
}

template <std::size_t kInstants>
LatticeBoxes<kInstants> BoxBlock<kInstants>::get(std::size_t place) const {
  LatticeBoxes<kInstants> boxes{};
  for (std::size_t i = 0; i < kInstants; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      boxes[i].min[k] = min[i][k][place];
      boxes[i].max[k] = max[i][k][place];
    }
  }
  return boxes;
}

template <std::size_t kInstants>
LatticeBoxes<kInstants> BoxBlock<kInstants>::bounds() const {
  LatticeBoxes<kInstants> boxes{};
  for (std::size_t i = 0; i < kInstants; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      boxes[i].min[k] = std::ranges::min(min[i][k]);
      boxes[i].max[k] = std::ranges::max(max[i][k]);
    }
  }
  return boxes;
}

template LatticeBoxes<1> on_lattices(const Lattices<1>&, const Boxes<1>&);
template LatticeBoxes<2> on_lattices(const Lattices<2>&, const Boxes<2>&);
template struct BoxBlock<1>;
template struct BoxBlock<2>;

}  // namespace selvage::verify
