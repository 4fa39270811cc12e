// All pairs of boxes that overlap.
#pragma once

#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "verify/search/block_tree.h"

namespace selvage::verify {

/// A tree over boxes. Work is done by blocks of eight boxes, which callers may spread over threads.
class BoxTree {
 public:
  /// The lattice must be common to all trees that are queried together. O(n log n).
  BoxTree(std::span<const Box> boxes, const Lattice& lattice);

  [[nodiscard]] std::size_t size() const { return boxes_.size(); }
  [[nodiscard]] std::size_t block_count() const { return blocks_.size(); }

  /// Calls visit(i, j) once for every pair of overlapping boxes of this tree of which the first in tree order is in
  /// `block`; over all blocks: every unordered pair i != j once, in a fixed order. Returns how many blocks were
  /// compared.
  template <class Visit>
  std::int64_t visit_pairs_within(std::size_t block, Visit&& visit) const {
    return tree_.visit(block_bounds_[block], block, [&](std::span<const std::uint32_t> others) {
      for (const std::uint32_t other : others) visit_block_pair<true>(block, *this, other, visit);
    });
  }
  /// Calls visit(i, j) once for every box i of `block` and box j of `other` that overlap. Returns the same.
  template <class Visit>
  std::int64_t visit_pairs_between(std::size_t block, const BoxTree& other, Visit&& visit) const {
    return other.tree_.visit(block_bounds_[block], 0, [&](std::span<const std::uint32_t> others) {
      for (const std::uint32_t theirs : others) visit_block_pair<false>(block, other, theirs, visit);
    });
  }

 private:
  static constexpr std::size_t kWidth = BoxBlock::kWidth;

  template <bool within, class Visit>
  void visit_block_pair(std::size_t block, const BoxTree& other, std::size_t other_block, Visit& visit) const;

  std::vector<BoxBlock> blocks_;  // in tree order
  std::vector<LatticeBox> block_bounds_;
  BlockTree tree_;
  std::vector<Box> boxes_;           // in tree order
  std::vector<std::int32_t> order_;  // tree order -> index of the caller
};

template <bool within, class Visit>
void BoxTree::visit_block_pair(std::size_t block, const BoxTree& other, std::size_t other_block, Visit& visit) const {
  const BoxBlock &mine = blocks_[block], &theirs = other.blocks_[other_block];
  unsigned waiting = mine.overlap_mask(other.block_bounds_[other_block]);
  for (; waiting != 0; waiting &= waiting - 1) {
    const auto i = static_cast<std::size_t>(std::countr_zero(waiting));
    unsigned mask = theirs.overlap_mask(mine.get(i));
    if (within && block == other_block) mask &= ~0U << (i + 1);  // later boxes only
    for (; mask != 0; mask &= mask - 1) {
      const std::size_t p = kWidth * block + i;
      const std::size_t q = kWidth * other_block + static_cast<std::size_t>(std::countr_zero(mask));
      if (boxes_[p].overlaps(other.boxes_[q])) visit(order_[p], other.order_[q]);
    }
  }
}

}  // namespace selvage::verify
