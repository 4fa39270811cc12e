// A flat tree of eight-fold nodes over blocks of eight elements, and the order that puts near elements into one block.
// The checker's own; it shares nothing with the kernel's hierarchy (V2).
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "verify/box_block.h"

namespace selvage::verify {

/// Morton code of a point of the lattice; which code it is affects speed alone.
[[nodiscard]] std::uint64_t morton_code(const std::array<std::int32_t, 3>& point);

/// The elements' numbers in ascending order of their codes, equal ones in ascending order. code(i) is called once for
/// every i < count, in parallel; deterministic. O(n log n).
[[nodiscard]] std::vector<std::int32_t> order_by_code(std::size_t count,
                                                      const std::function<std::uint64_t(std::size_t)>& code);

class BlockTree {
 public:
  static constexpr std::size_t kWidth = BoxBlock::kWidth;

  BlockTree() = default;
  /// Over blocks with these bounds.
  explicit BlockTree(std::span<const LatticeBox> bounds);

  /// Calls visit(b) for the blocks b >= first that overlap `box`, in ascending order.
  template <class Visit>
  void visit(const LatticeBox& box, std::size_t first, Visit&& visit) const;

 private:
  // levels_[0] block b place p bounds block 8 b + p; levels_[1] bounds levels_[0]
  std::vector<std::vector<BoxBlock>> levels_;
};

template <class Visit>
void BlockTree::visit(const LatticeBox& box, std::size_t first, Visit&& visit) const {
  if (levels_.empty()) return;
  struct Node {
    std::size_t level, block;
  };
  // 8^11 > 2^31 blocks: at most 11 levels, each leaves at most 7 siblings waiting.
  std::array<Node, 12 * kWidth> stack;
  std::size_t depth = 0;
  stack[depth++] = {levels_.size() - 1, 0};
  while (depth > 0) {
    const Node node = stack[--depth];
    unsigned mask = levels_[node.level][node.block].overlap_mask(box);
    // Child c covers blocks up to ((8 block + c + 1) << 3 level) - 1.
    const std::size_t first_child = first >> (3 * node.level);
    if (first_child > kWidth * node.block) mask &= ~0U << std::min(first_child - kWidth * node.block, kWidth);
    if (node.level == 0) {
      for (; mask != 0; mask &= mask - 1) visit(kWidth * node.block + static_cast<std::size_t>(std::countr_zero(mask)));
      continue;
    }
    for (; mask != 0; mask &= ~std::bit_floor(mask)) {  // pushed from the last, popped from the first
      const auto child = static_cast<std::size_t>(std::bit_width(mask) - 1);
      stack[depth++] = {node.level - 1, kWidth * node.block + child};
    }
  }
}

}  // namespace selvage::verify
