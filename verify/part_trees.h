// Box trees over the cloth part and the body part of one kind of element, and the pairs a check owes.
#pragma once

#include <vector>

#include "verify/search/box_pairs.h"
#include "verify/surface/topology.h"
#include "verify/tally.h"

namespace selvage::verify {

/// A box tree over some elements of a mesh, which are named by their own numbers.
template <std::size_t kInstants>
class ElementTree {
 public:
  /// boxes_of(element): Boxes. `elements` must outlive it.
  template <class BoxesOf>
  ElementTree(const std::vector<std::int32_t>& elements, const Lattices<kInstants>& lattices, const BoxesOf& boxes_of)
      : elements_(&elements), tree_(boxes(elements, lattices, boxes_of)) {}

  [[nodiscard]] std::size_t group_count() const { return tree_.block_count(); }
  template <class Visit>
  std::int64_t visit_pairs_within(std::size_t group, const Visit& visit) const {
    return tree_.visit_pairs_within(group, [&](std::int32_t i, std::int32_t j) { visit(element(i), element(j)); });
  }
  template <class Visit>
  std::int64_t visit_pairs_between(std::size_t group, const ElementTree& other, const Visit& visit) const {
    return tree_.visit_pairs_between(group, other.tree_,
                                     [&](std::int32_t i, std::int32_t j) { visit(element(i), other.element(j)); });
  }

 private:
  template <class BoxesOf>
  static std::vector<LatticeBoxes<kInstants>> boxes(const std::vector<std::int32_t>& elements,
                                                    const Lattices<kInstants>& lattices, const BoxesOf& boxes_of) {
    std::vector<LatticeBoxes<kInstants>> result(elements.size());
    for (std::size_t i = 0; i < elements.size(); ++i) result[i] = on_lattices(lattices, boxes_of(elements[i]));
    return result;
  }
  [[nodiscard]] std::int32_t element(std::int32_t i) const { return (*elements_)[static_cast<std::size_t>(i)]; }

  const std::vector<std::int32_t>* elements_;
  BoxTree<kInstants> tree_;
};

/// Tree: ElementTree or FaceTree, whose visits these are: work(tally, what the tree's visit gets).
template <class Tree>
class PartTrees {
 public:
  /// Trees made of (elements of the part, arguments...).
  template <class... Arguments>
  explicit PartTrees(const Parts& parts, const Arguments&... arguments)
      : cloth_(parts.cloth, arguments...), body_(parts.body, arguments...) {}

  /// All pairs of different elements whose boxes may meet; those of two body elements only if asked. `options`: those
  /// of the tree's visits.
  template <class Work, class... Options>
  void tally_within(bool bodies, std::size_t limit, Tally& tally, const Work& work, Options... options) const {
    within(cloth_, limit, tally, work, options...);
    between(cloth_, body_, limit, tally, work, options...);
    if (bodies) within(body_, limit, tally, work, options...);
  }
  /// All such pairs of an element here and one of `other`.
  template <class Work>
  void tally_between(const PartTrees& other, bool bodies, std::size_t limit, Tally& tally, const Work& work) const {
    between(cloth_, other.cloth_, limit, tally, work);
    between(cloth_, other.body_, limit, tally, work);
    between(body_, other.cloth_, limit, tally, work);
    if (bodies) between(body_, other.body_, limit, tally, work);
  }

 private:
  template <class Work, class... Options>
  static void within(const Tree& tree, std::size_t limit, Tally& tally, const Work& work, Options... options) {
    tally_in_parallel(tree.group_count(), limit, tally, [&](std::size_t group, Tally& chunk) {
      chunk.block_pairs += tree.visit_pairs_within(group, options..., [&](auto... found) {
        chunk.count_visit();
        work(chunk, found...);
      });
    });
  }
  template <class Work, class... Options>
  static void between(const Tree& a, const Tree& b, std::size_t limit, Tally& tally, const Work& work,
                      Options... options) {
    tally_in_parallel(a.group_count(), limit, tally, [&](std::size_t group, Tally& chunk) {
      chunk.block_pairs += a.visit_pairs_between(group, b, options..., [&](auto... found) {
        chunk.count_visit();
        work(chunk, found...);
      });
    });
  }

  Tree cloth_, body_;
};

}  // namespace selvage::verify
