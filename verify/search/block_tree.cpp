#include "verify/search/block_tree.h"

#include <utility>

namespace selvage::verify {

template <std::size_t kInstants>
BlockTree<kInstants>::BlockTree(std::span<const LatticeBoxes<kInstants>> bounds) {
  if (bounds.empty()) return;
  levels_.emplace_back((bounds.size() + kWidth - 1) / kWidth);
  for (std::size_t i = 0; i < bounds.size(); ++i) levels_.front()[i / kWidth].set(i % kWidth, bounds[i]);
  while (levels_.back().size() > 1) {
    const std::vector<Block>& below = levels_.back();
    std::vector<Block> level((below.size() + kWidth - 1) / kWidth);
    for (std::size_t i = 0; i < below.size(); ++i) level[i / kWidth].set(i % kWidth, below[i].bounds());
    levels_.push_back(std::move(level));
  }
}

template class BlockTree<1>;
template class BlockTree<2>;

}  // namespace selvage::verify
