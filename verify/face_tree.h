// All pairs of faces whose boxes overlap at one instant, and which of them the first filter proves apart.
#pragma once

#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "verify/block_tree.h"
#include "verify/face_block.h"

namespace selvage::verify {

/// A tree over some faces of a mesh. Work is done by blocks of eight faces, which callers may spread over threads.
class FaceTree {
 public:
  /// The spans must outlive it. The frame must be common to all trees that are queried together, and hold all of V.
  FaceTree(std::span<const std::int32_t> faces, std::span<const std::array<std::int32_t, 3>> triangles,
           std::span<const Point> V, const FloatFrame& frame);

  [[nodiscard]] std::size_t block_count() const { return blocks_.size(); }

  /// Every pair of faces whose boxes overlap and of which the first in tree order is in `block`; over all blocks: every
  /// unordered pair f != g once, in a fixed order. Pairs that are proved to have no point in common but the corners
  /// that they share by index are counted, visit(count), or, if `each`, visited, visit(f, g, true). All others are
  /// visited: visit(f, g, false).
  template <class Visit>
  void visit_pairs_within(std::size_t block, bool each, Visit&& visit) const {
    const FaceQuery mine(blocks_[block]);
    tree_.visit(lattice_bounds(block), block,
                [&](std::size_t other) { visit_block_pair<true>(block, mine, *this, other, each, visit); });
  }
  /// The same for every face f of `block` and g of `other`.
  template <class Visit>
  void visit_pairs_between(std::size_t block, const FaceTree& other, bool each, Visit&& visit) const {
    const FaceQuery mine(blocks_[block]);
    other.tree_.visit(lattice_bounds(block), 0, [&](std::size_t other_block) {
      visit_block_pair<false>(block, mine, other, other_block, each, visit);
    });
  }

 private:
  static constexpr std::size_t kWidth = FaceBlock::kWidth;
  struct Bounds {
    std::array<float, 3> min, max;
  };

  [[nodiscard]] LatticeBox lattice_bounds(std::size_t block) const;
  template <bool within, class Visit>
  void visit_block_pair(std::size_t block, const FaceQuery& mine, const FaceTree& other, std::size_t other_block,
                        bool each, Visit& visit) const;
  /// Of the faces as they are in V.
  [[nodiscard]] bool boxes_overlap(std::int32_t f, std::int32_t g) const;

  std::span<const std::array<std::int32_t, 3>> triangles_;
  std::span<const Point> V_;
  std::vector<std::int32_t> order_;  // tree order -> face
  std::vector<FaceBlock> blocks_;
  std::vector<Bounds> bounds_;  // of the blocks
  BlockTree tree_;
};

/// Of a byte; processors of the baseline have no instruction for it.
inline constexpr auto kBitCount = [] {
  std::array<std::uint8_t, 256> counts{};
  for (std::size_t i = 1; i < counts.size(); ++i) counts[i] = static_cast<std::uint8_t>(counts[i / 2] + i % 2);
  return counts;
}();

template <bool within, class Visit>
void FaceTree::visit_block_pair(std::size_t block, const FaceQuery& mine, const FaceTree& other,
                                std::size_t other_block, bool each, Visit& visit) const {
  const Bounds& bounds = other.bounds_[other_block];
  std::array<FaceBlock::Masks, kWidth> found;
  unsigned waiting = other.blocks_[other_block].compare(mine, bounds.min, bounds.max, found);
  std::int64_t apart_count = 0;
  for (; waiting != 0; waiting &= waiting - 1) {
    const auto i = static_cast<std::size_t>(std::countr_zero(waiting));
    const FaceBlock::Masks masks = found[i];
    unsigned meet = masks.meet;
    if (within && block == other_block) meet &= ~0U << (i + 1);  // later faces only
    const std::int32_t f = order_[kWidth * block + i];
    if (!each) {
      apart_count += kBitCount[meet & masks.apart];
      meet &= ~masks.apart;
    }
    for (; meet != 0; meet &= meet - 1) {
      const auto j = static_cast<std::size_t>(std::countr_zero(meet));
      const std::int32_t g = other.order_[kWidth * other_block + j];
      const bool apart = (masks.apart >> j & 1U) != 0;
      if (apart || boxes_overlap(f, g)) visit(f, g, apart);
    }
  }
  if (apart_count > 0) visit(apart_count);
}

}  // namespace selvage::verify
