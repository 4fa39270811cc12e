#include "verify/search/box_pairs.h"

#include <numeric>

#include <tbb/blocked_range.h>

#include "verify/arithmetic/fp_guard.h"
#include "verify/search/curve_order.h"
#include "verify/search/own_tasks.h"

namespace selvage::verify {

BoxTree::BoxTree(std::span<const Box> boxes, const Lattice& lattice)
    : blocks_((boxes.size() + kWidth - 1) / kWidth), block_bounds_(blocks_.size()), boxes_(boxes.size()) {
  const auto quantized = [&](const Box& box) {
    LatticeBox q{};
    for (std::size_t k = 0; k < 3; ++k) {
      q.min[k] = lattice(k, box.min[k]);
      q.max[k] = lattice(k, box.max[k]);
    }
    return q;
  };
  order_ = order_by_code(boxes.size(), [&](std::size_t i) {
    const LatticeBox box = quantized(boxes[i]);
    std::array<std::int32_t, 3> middle{};
    for (std::size_t k = 0; k < 3; ++k) middle[k] = std::midpoint(box.min[k], box.max[k]);
    return hilbert_code(middle);
  });
  own_parallel_for(tbb::blocked_range<std::size_t>(0, blocks_.size()), [&](const auto& range) {
    const FpGuard guard;  // all threads must round alike: boxes are compared on the lattice only
    for (std::size_t b = range.begin(); b < range.end(); ++b) {
      for (std::size_t i = b * kWidth; i < std::min((b + 1) * kWidth, boxes.size()); ++i) {
        boxes_[i] = boxes[static_cast<std::size_t>(order_[i])];
        blocks_[b].set(i % kWidth, quantized(boxes_[i]));
      }
      block_bounds_[b] = blocks_[b].bounds();
    }
  });
  tree_ = BlockTree(block_bounds_);
}

}  // namespace selvage::verify
