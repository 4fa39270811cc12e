// A flat tree of eight-fold nodes over blocks of eight elements.
// The checker's own; it shares nothing with the kernel's hierarchy (V2).
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "verify/search/box_block.h"
#include "verify/search/set_bits.h"

namespace selvage::verify {

template <std::size_t kInstants>
class BlockTree {
 public:
  using Block = BoxBlock<kInstants>;
  static constexpr std::size_t kWidth = Block::kWidth, kMaxVisited = 32;

  BlockTree() = default;
  /// Over blocks with these bounds.
  explicit BlockTree(std::span<const LatticeBoxes<kInstants>> bounds);

  /// What holds the blocks 8 i, ..., 8 i + 7.
  [[nodiscard]] LatticeBoxes<kInstants> bounds(std::size_t i) const { return levels_.front()[i].bounds(); }

  /// Calls visit(blocks) with the blocks >= first that may meet `boxes`, in ascending order, at most kMaxVisited at
  /// once. Returns how many.
  template <class Visit>
  std::int64_t visit(const LatticeBoxes<kInstants>& boxes, std::size_t first, Visit&& visit) const;

 private:
  // levels_[0] block b place p bounds block 8 b + p; levels_[1] bounds levels_[0]
  std::vector<std::vector<Block>> levels_;
};

template <std::size_t kInstants>
template <class Visit>
std::int64_t BlockTree<kInstants>::visit(const LatticeBoxes<kInstants>& boxes, std::size_t first, Visit&& visit) const {
  if (levels_.empty()) return 0;
  struct Node {
    std::size_t level, block;
  };
  // 8^11 > 2^31 blocks: at most 11 levels, each leaves at most 7 siblings waiting.
  std::array<Node, 12 * kWidth> stack;
  std::size_t depth = 0;
  std::array<std::uint32_t, kMaxVisited> found;
  std::size_t found_count = 0;
  std::int64_t visited = 0;
  stack[depth++] = {levels_.size() - 1, 0};
  while (depth > 0) {
    const Node node = stack[--depth];
    unsigned mask = levels_[node.level][node.block].meet_mask(boxes);
    // Child c covers blocks up to ((8 block + c + 1) << 3 level) - 1.
    const std::size_t first_child = first >> (3 * node.level);
    if (first_child > kWidth * node.block) mask &= ~0U << std::min(first_child - kWidth * node.block, kWidth);
    if (node.level == 0) {
      for (std::size_t i = 0; i < kWidth; ++i) {
        found[found_count + i] = static_cast<std::uint32_t>(kWidth * node.block + kSetBits[mask][i]);
      }
      found_count += kBitCount[mask];
      if (found_count + kWidth > kMaxVisited) {
        visit(std::span(found).first(found_count));
        visited += static_cast<std::int64_t>(found_count);
        found_count = 0;
      }
      continue;
    }
    for (; mask != 0; mask &= ~std::bit_floor(mask)) {  // pushed from the last, popped from the first
      const auto child = static_cast<std::size_t>(std::bit_width(mask) - 1);
      stack[depth++] = {node.level - 1, kWidth * node.block + child};
    }
  }
  if (found_count > 0) visit(std::span(found).first(found_count));
  return visited + static_cast<std::int64_t>(found_count);
}

}  // namespace selvage::verify
