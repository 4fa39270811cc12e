// All pairs of boxes that may meet.
#pragma once

#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "verify/search/block_tree.h"

namespace selvage::verify {

/// A tree over boxes on lattices. Work is done by blocks of eight boxes, which callers may spread over threads.
template <std::size_t kInstants>
class BoxTree {
 public:
  /// The lattices must be those of all trees that are queried together. O(n log n).
  explicit BoxTree(std::span<const LatticeBoxes<kInstants>> boxes);

  [[nodiscard]] std::size_t block_count() const { return blocks_.size(); }

  /// Calls visit(i, j) once for every pair of this tree that may meet and of which the first in tree order is in
  /// `block`; over all blocks: every unordered pair i != j once, in a fixed order. Returns how many blocks were
  /// compared.
  template <class Visit>
  std::int64_t visit_pairs_within(std::size_t block, Visit&& visit) const {
    return tree_.visit(block_bounds_[block], block, [&](std::span<const std::uint32_t> others) {
      for (const std::uint32_t other : others) visit_block_pair<true>(block, *this, other, visit);
    });
  }
  /// Calls visit(i, j) once for all boxes i of `block` and j of `other` that may meet. Returns the same.
  template <class Visit>
  std::int64_t visit_pairs_between(std::size_t block, const BoxTree& other, Visit&& visit) const {
    return other.tree_.visit(block_bounds_[block], 0, [&](std::span<const std::uint32_t> others) {
      for (const std::uint32_t theirs : others) visit_block_pair<false>(block, other, theirs, visit);
    });
  }

 private:
  using Block = BoxBlock<kInstants>;
  static constexpr std::size_t kWidth = Block::kWidth;

  template <bool within, class Visit>
  void visit_block_pair(std::size_t block, const BoxTree& other, std::size_t other_block, Visit& visit) const;

  std::vector<Block> blocks_;  // in tree order
  std::vector<LatticeBoxes<kInstants>> block_bounds_;
  BlockTree<kInstants> tree_;
  std::vector<std::int32_t> order_;  // tree order -> index of the caller
};

template <std::size_t kInstants>
template <bool within, class Visit>
void BoxTree<kInstants>::visit_block_pair(std::size_t block, const BoxTree& other, std::size_t other_block,
                                          Visit& visit) const {
  const Block &mine = blocks_[block], &theirs = other.blocks_[other_block];
  unsigned waiting = mine.meet_mask(other.block_bounds_[other_block]);
  for (; waiting != 0; waiting &= waiting - 1) {
    const auto i = static_cast<std::size_t>(std::countr_zero(waiting));
    unsigned mask = theirs.meet_mask(mine.get(i));
    if (within && block == other_block) mask &= ~0U << (i + 1);  // later boxes only
    for (; mask != 0; mask &= mask - 1) {
      const std::size_t p = kWidth * block + i;
      const std::size_t q = kWidth * other_block + static_cast<std::size_t>(std::countr_zero(mask));
      visit(order_[p], other.order_[q]);
    }
  }
}

}  // namespace selvage::verify
