#include "verify/search/box_pairs.h"

#include <algorithm>
#include <numeric>

#include <tbb/blocked_range.h>

#include "verify/search/curve_order.h"
#include "verify/search/own_tasks.h"

namespace selvage::verify {

template <std::size_t kInstants>
BoxTree<kInstants>::BoxTree(std::span<const LatticeBoxes<kInstants>> boxes)
    : blocks_((boxes.size() + kWidth - 1) / kWidth), block_bounds_(blocks_.size()) {
  order_ = order_by_code(boxes.size(), [&](std::size_t i) {
    const LatticeBox &first = boxes[i].front(), &last = boxes[i].back();
    std::array<std::int32_t, 3> middle{};
    for (std::size_t k = 0; k < 3; ++k) {
      middle[k] = std::midpoint(std::midpoint(first.min[k], first.max[k]), std::midpoint(last.min[k], last.max[k]));
    }
    return hilbert_code(middle);
  });
  own_parallel_for(tbb::blocked_range<std::size_t>(0, blocks_.size()), [&](const auto& range) {
    for (std::size_t b = range.begin(); b < range.end(); ++b) {
      for (std::size_t i = b * kWidth; i < std::min((b + 1) * kWidth, boxes.size()); ++i) {
        blocks_[b].set(i % kWidth, boxes[static_cast<std::size_t>(order_[i])]);
      }
      block_bounds_[b] = blocks_[b].bounds();
    }
  });
  tree_ = BlockTree<kInstants>(block_bounds_);
}

template class BoxTree<1>;
template class BoxTree<2>;

}  // namespace selvage::verify
