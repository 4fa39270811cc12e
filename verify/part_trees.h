// Box trees over the cloth part and the body part of one kind of element, and the pairs a check owes.
#pragma once

#include <vector>

#include "verify/box_pairs.h"
#include "verify/tally.h"
#include "verify/topology.h"

namespace selvage::verify {

class PartTrees {
 public:
  /// box(element) for every element of both parts; all within the lattice's bounds.
  template <class BoxOf>
  PartTrees(const Parts& parts, const Lattice& lattice, const BoxOf& box)
      : cloth_(tree(parts.cloth, lattice, box)), body_(tree(parts.body, lattice, box)) {}

  /// work(i, j, tally) for all overlapping pairs of different elements; those of two body elements only if asked.
  template <class Work>
  void tally_within(bool bodies, std::size_t limit, Tally& tally, const Work& work) const {
    within(cloth_, limit, tally, work);
    between(cloth_, body_, limit, tally, work);
    if (bodies) within(body_, limit, tally, work);
  }
  /// work(i, j, tally) for all overlapping pairs of an element here and one of `other`.
  template <class Work>
  void tally_between(const PartTrees& other, bool bodies, std::size_t limit, Tally& tally, const Work& work) const {
    between(cloth_, other.cloth_, limit, tally, work);
    between(cloth_, other.body_, limit, tally, work);
    between(body_, other.cloth_, limit, tally, work);
    if (bodies) between(body_, other.body_, limit, tally, work);
  }

 private:
  struct Part {
    const std::vector<std::int32_t>* elements;
    BoxTree tree;
  };

  template <class BoxOf>
  static Part tree(const std::vector<std::int32_t>& elements, const Lattice& lattice, const BoxOf& box) {
    std::vector<Box> boxes(elements.size());
    for (std::size_t i = 0; i < elements.size(); ++i) boxes[i] = box(elements[i]);
    return {&elements, BoxTree(boxes, lattice)};
  }

  template <class Work>
  static void within(const Part& part, std::size_t limit, Tally& tally, const Work& work) {
    tally_in_parallel(part.tree.block_count(), limit, tally, [&](std::size_t block, Tally& chunk) {
      part.tree.visit_pairs_within(
          block, [&](std::int32_t i, std::int32_t j) { work(element(part, i), element(part, j), chunk); });
    });
  }
  template <class Work>
  static void between(const Part& a, const Part& b, std::size_t limit, Tally& tally, const Work& work) {
    tally_in_parallel(a.tree.block_count(), limit, tally, [&](std::size_t block, Tally& chunk) {
      a.tree.visit_pairs_between(block, b.tree,
                                 [&](std::int32_t i, std::int32_t j) { work(element(a, i), element(b, j), chunk); });
    });
  }
  static std::int32_t element(const Part& part, std::int32_t i) {
    return (*part.elements)[static_cast<std::size_t>(i)];
  }

  Part cloth_, body_;
};

}  // namespace selvage::verify
