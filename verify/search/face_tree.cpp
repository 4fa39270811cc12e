#include "verify/search/face_tree.h"

#include <algorithm>

#include <tbb/blocked_range.h>

#include "verify/arithmetic/fp_guard.h"
#include "verify/search/curve_order.h"
#include "verify/search/own_tasks.h"

namespace selvage::verify {
namespace {

/// Exact: a number of [-1, 1] times 2^30, towards zero. Does not reverse an order.
LatticeBox on_lattice(const FaceBounds& bounds) {
  LatticeBox box{};
  for (std::size_t k = 0; k < 3; ++k) {
    box.min[k] = static_cast<std::int32_t>(bounds.min[k] * 0x1p30f);
    box.max[k] = static_cast<std::int32_t>(bounds.max[k] * 0x1p30f);
  }
  return box;
}

Box box_of(const std::array<std::int32_t, 3>& triangle, std::span<const Point> V) {
  const auto at = [V](std::int32_t v) -> const Point& { return V[static_cast<std::size_t>(v)]; };
  return bounding_box(std::array{at(triangle[0]), at(triangle[1]), at(triangle[2])});
}

}  // namespace

FaceTree::FaceTree(std::span<const std::int32_t> faces, std::span<const std::array<std::int32_t, 3>> triangles,
                   std::span<const Point> V, const FloatFrame& frame)
    : triangles_(triangles), V_(V) {
  order_ = order_by_code(faces.size(), [&](std::size_t i) {
    const auto& [a, b, c] = triangles[static_cast<std::size_t>(faces[i])];
    std::array<std::int32_t, 3> middle{};
    for (std::size_t k = 0; k < 3; ++k) {
      const auto stored = [&](std::int32_t v) { return frame(k, V[static_cast<std::size_t>(v)][k]); };
      const std::array<float, 3> x = {stored(a), stored(b), stored(c)};
      const auto [min, max] = std::minmax_element(x.begin(), x.end());
      middle[k] = static_cast<std::int32_t>((*min + *max) * 0x1p29f);
    }
    return hilbert_code(middle);
  });
  for (std::int32_t& f : order_) f = faces[static_cast<std::size_t>(f)];
  blocks_.resize((faces.size() + kWidth - 1) / kWidth);
  bounds_.resize(blocks_.size());
  own_parallel_for(tbb::blocked_range<std::size_t>(0, blocks_.size()), [&](const auto& range) {
    const FpGuard guard;
    for (std::size_t b = range.begin(); b < range.end(); ++b) {
      FaceBounds bounds;
      for (std::size_t i = b * kWidth; i < std::min((b + 1) * kWidth, faces.size()); ++i) {
        const FloatFace face(triangles[static_cast<std::size_t>(order_[i])], V, frame);
        blocks_[b].set(i % kWidth, face);
        for (std::size_t k = 0; k < 3; ++k) {
          bounds.min[k] = std::min(bounds.min[k], face.min[k]);
          bounds.max[k] = std::max(bounds.max[k], face.max[k]);
        }
      }
      bounds_[b] = bounds;
    }
  });
  std::vector<LatticeBoxes<1>> lattice_boxes(blocks_.size());
  for (std::size_t b = 0; b < blocks_.size(); ++b) lattice_boxes[b] = {on_lattice(bounds_[b])};
  tree_ = BlockTree<1>(lattice_boxes);
}

bool FaceTree::boxes_overlap(std::int32_t f, std::int32_t g) const {
  const Box a = box_of(triangles_[static_cast<std::size_t>(f)], V_),
            b = box_of(triangles_[static_cast<std::size_t>(g)], V_);
  return a.overlaps(b);
}

}  // namespace selvage::verify
