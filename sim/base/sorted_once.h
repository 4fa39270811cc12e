// Lists that are sets: sorted, so that what reads them does not depend on who found what first.
#pragma once

#include <algorithm>
#include <vector>

namespace selvage::sim {

/// Sorts the items and leaves one of those that are equal. O(n log n).
template <class Item>
void keep_sorted_once(std::vector<Item>& items) {
  std::ranges::sort(items);
  items.erase(std::unique(items.begin(), items.end()), items.end());
}

}  // namespace selvage::sim
