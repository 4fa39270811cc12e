// All pairs of boxes that overlap: a flat tree of eight-fold nodes over boxes in Morton order. The checker's own; it
// shares nothing with the kernel's hierarchy (V2).
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "verify/box_block.h"

namespace selvage::verify {

/// A tree over boxes. Work is done by blocks of eight boxes, which callers may spread over threads.
class BoxTree {
 public:
  /// The lattice must be common to all trees that are queried together. O(n log n).
  BoxTree(std::span<const Box> boxes, const Lattice& lattice);

  [[nodiscard]] std::size_t size() const { return boxes_.size(); }
  [[nodiscard]] std::size_t block_count() const { return levels_.empty() ? 0 : levels_.front().size(); }

  /// Calls visit(i, j) once for every pair of overlapping boxes of this tree of which the first in tree order is in
  /// `block`; over all blocks: every unordered pair i != j once, in a fixed order.
  template <class Visit>
  void visit_pairs_within(std::size_t block, Visit&& visit) const {
    visit_blocks(block_bounds_[block], block,
                 [&](std::size_t other) { visit_block_pair<true>(block, *this, other, visit); });
  }
  /// Calls visit(i, j) once for every box i of `block` and box j of `other` that overlap.
  template <class Visit>
  void visit_pairs_between(std::size_t block, const BoxTree& other, Visit&& visit) const {
    other.visit_blocks(block_bounds_[block], 0,
                       [&](std::size_t other_block) { visit_block_pair<false>(block, other, other_block, visit); });
  }

 private:
  static constexpr std::size_t kWidth = BoxBlock::kWidth;

  /// Calls visit(b) for the blocks b >= first that overlap `box`.
  template <class Visit>
  void visit_blocks(const LatticeBox& box, std::size_t first, Visit&& visit) const;
  template <bool within, class Visit>
  void visit_block_pair(std::size_t block, const BoxTree& other, std::size_t other_block, Visit& visit) const;

  std::vector<std::vector<BoxBlock>> levels_;  // levels_[l + 1] block b place p bounds levels_[l] block 8 b + p
  std::vector<LatticeBox> block_bounds_;       // of levels_[0]
  std::vector<Box> boxes_;                     // in tree order
  std::vector<std::int32_t> order_;            // tree order -> index of the caller
};

template <class Visit>
void BoxTree::visit_blocks(const LatticeBox& box, std::size_t first, Visit&& visit) const {
  if (levels_.empty()) return;
  struct Node {
    std::size_t level, block;
  };
  // 8^11 > 2^31 boxes: at most 11 levels, each leaves at most 7 siblings waiting.
  std::array<Node, 12 * kWidth> stack;
  std::size_t depth = 0;
  stack[depth++] = {levels_.size() - 1, 0};
  while (depth > 0) {
    const Node node = stack[--depth];
    if (node.level == 0) {
      visit(node.block);
      continue;
    }
    unsigned mask = levels_[node.level][node.block].overlap_mask(box);
    // Child c covers leaf blocks up to ((8 block + c + 1) << 3 (level - 1)) - 1.
    const std::size_t shift = 3 * (node.level - 1);
    const std::size_t first_child = first >> shift;
    if (first_child > kWidth * node.block) mask &= ~0U << std::min(first_child - kWidth * node.block, kWidth);
    for (; mask != 0; mask &= ~std::bit_floor(mask)) {  // pushed from the last, popped from the first
      const auto child = static_cast<std::size_t>(std::bit_width(mask) - 1);
      stack[depth++] = {node.level - 1, kWidth * node.block + child};
    }
  }
}

template <bool within, class Visit>
void BoxTree::visit_block_pair(std::size_t block, const BoxTree& other, std::size_t other_block, Visit& visit) const {
  const BoxBlock &mine = levels_.front()[block], &theirs = other.levels_.front()[other_block];
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
