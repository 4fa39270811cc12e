// All pairs of faces whose boxes overlap at one instant, and which of them the first filter proves apart.
#pragma once

#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "verify/search/block_tree.h"
#include "verify/search/face_compare.h"

namespace selvage::verify {

/// A tree over some faces of a mesh. Work is done by groups of 64 faces, which callers may spread over threads.
class FaceTree {
 public:
  /// The spans must outlive it. The frame must be common to all trees that are queried together. It need not hold all
  /// of their faces: what is beyond it is found as well, and nothing is proved of it.
  FaceTree(std::span<const std::int32_t> faces, std::span<const std::array<std::int32_t, 3>> triangles,
           std::span<const Point> V, const FloatFrame& frame);

  [[nodiscard]] std::size_t group_count() const { return (blocks_.size() + kGroup - 1) / kGroup; }

  /// Every pair of faces whose boxes overlap and of which the first in tree order is in `group`; over all groups: every
  /// unordered pair f != g once, in a fixed order. Pairs that are proved to have no point in common but the corners
  /// that they share by index are counted, visit(count), or, if `each`, visited, visit(f, g, true). All others are
  /// visited: visit(f, g, false). Returns how many blocks were compared with the group.
  template <class Visit>
  std::int64_t visit_pairs_within(std::size_t group, bool each, Visit&& visit) const {
    return visit_pairs(group, *this, static_cast<std::int64_t>(kGroup * group), each, visit);
  }
  /// The same for every face f of `group` and g of `other`.
  template <class Visit>
  std::int64_t visit_pairs_between(std::size_t group, const FaceTree& other, bool each, Visit&& visit) const {
    return visit_pairs(group, other, kOtherTree, each, visit);
  }

 private:
  static constexpr std::size_t kWidth = FaceBlock::kWidth, kGroup = FaceQuery::kBlocks;
  static_assert(BlockTree<1>::kMaxVisited <= FaceMatches::kMaxBlocks);
  /// `first`: the first block of the group in `other`, kOtherTree if that is another tree.
  template <class Visit>
  std::int64_t visit_pairs(std::size_t group, const FaceTree& other, std::int64_t first, bool each, Visit& visit) const;
  /// Of the faces as they are in V.
  [[nodiscard]] bool boxes_overlap(std::int32_t f, std::int32_t g) const;

  std::span<const std::array<std::int32_t, 3>> triangles_;
  std::span<const Point> V_;
  std::vector<std::int32_t> order_;  // tree order -> face
  std::vector<FaceBlock> blocks_;
  std::vector<FaceBounds> bounds_;  // of the blocks
  BlockTree<1> tree_;
};

template <class Visit>
std::int64_t FaceTree::visit_pairs(std::size_t group, const FaceTree& other, std::int64_t first, bool each,
                                   Visit& visit) const {
  const std::size_t begin = kGroup * group, count = std::min(kGroup, blocks_.size() - begin);
  const FaceQuery query({blocks_.data() + begin, count}, {bounds_.data() + begin, count});
  const CompareFaces compare = face_comparers().back().compare;
  FaceMatches found;
  const auto compare_with = [&](std::span<const std::uint32_t> chosen) {
    compare(query, first, other.blocks_, other.bounds_, chosen, each, found);
    if (!each) visit(found.apart_count);
    for (const FaceMatch& match : std::span(found.matches).first(found.count)) {
      const std::int32_t f = order_[kWidth * begin + match.place];
      for (unsigned pairs = each ? match.meet : match.meet & ~match.apart; pairs != 0; pairs &= pairs - 1) {
        const auto j = static_cast<std::size_t>(std::countr_zero(pairs));
        const std::int32_t g = other.order_[kWidth * match.block + j];
        const bool overlap = (match.overlap >> j & 1U) != 0;
        if (overlap || boxes_overlap(f, g)) visit(f, g, (match.apart >> j & 1U) != 0);
      }
    }
  };
  return other.tree_.visit(tree_.bounds(group), static_cast<std::size_t>(std::max<std::int64_t>(first, 0)),
                           compare_with);
}

}  // namespace selvage::verify
