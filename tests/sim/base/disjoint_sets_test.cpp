#include "sim/base/disjoint_sets.h"

#include <random>

#include <gtest/gtest.h>

namespace selvage::sim::testbed {

TEST(DisjointSets, AreNamedByTheirSmallestElementWhateverTheOrderOfJoins) {
  // Against labels that are painted over: each join makes one label of two.
  constexpr int kCount = 60;
  for (unsigned seed = 0; seed < 20; ++seed) {
    std::mt19937 random(seed);
    DisjointSets<int> sets(kCount);
    std::vector<int> label(kCount);
    for (int i = 0; i < kCount; ++i) label[static_cast<std::size_t>(i)] = i;
    for (int join = 0; join < 45; ++join) {
      const int a = static_cast<int>(random() % kCount), b = static_cast<int>(random() % kCount);
      sets.join(a, b);
      const int of_a = label[static_cast<std::size_t>(a)], of_b = label[static_cast<std::size_t>(b)];
      for (int& l : label) l = l == of_a || l == of_b ? std::min(of_a, of_b) : l;
    }
    for (int i = 0; i < kCount; ++i) EXPECT_EQ(sets.root(i), label[static_cast<std::size_t>(i)]) << i;
  }
}

}  // namespace selvage::sim::testbed
