// Sets that are joined one pair at a time, and asked for which of them an element is in: union-find.
#pragma once

#include <algorithm>
#include <numeric>
#include <vector>

namespace selvage::sim {

/// Of 0 .. count-1, each alone at the start. O(log count) a call, amortised: paths are halved, so that trees stay flat.
template <class Index>
class DisjointSets {
 public:
  explicit DisjointSets(Index count) : parent_(static_cast<std::size_t>(count)) {
    std::iota(parent_.begin(), parent_.end(), Index{0});
  }
  /// The smallest element of its set, whatever the order of the joins.
  [[nodiscard]] Index root(Index i) {
    while (parent(i) != i) i = parent(i) = parent(parent(i));
    return i;
  }
  void join(Index a, Index b) {
    a = root(a);
    b = root(b);
    parent(std::max(a, b)) = std::min(a, b);
  }

 private:
  Index& parent(Index i) { return parent_[static_cast<std::size_t>(i)]; }
  std::vector<Index> parent_;
};

}  // namespace selvage::sim
