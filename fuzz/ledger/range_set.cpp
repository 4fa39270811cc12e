#include "fuzz/ledger/range_set.h"

#include <algorithm>
#include <iterator>

namespace selvage::fuzz {

bool RangeSet::insert(std::int64_t begin, std::int64_t end) {
  auto next = std::lower_bound(ranges_.begin(), ranges_.end(), std::pair{begin, begin});
  const bool joins_previous = next != ranges_.begin() && std::prev(next)->second >= begin;
  if (joins_previous && std::prev(next)->second > begin) return false;
  if (next != ranges_.end() && next->first < end) return false;
  const bool joins_next = next != ranges_.end() && next->first == end;
  if (joins_previous && joins_next) {
    std::prev(next)->second = next->second;
    ranges_.erase(next);
  } else if (joins_previous) {
    std::prev(next)->second = end;
  } else if (joins_next) {
    next->first = begin;
  } else {
    ranges_.insert(next, {begin, end});
  }
  return true;
}

bool RangeSet::contains(std::int64_t number) const {
  const auto after = std::ranges::upper_bound(ranges_, number, {}, &Ranges::value_type::first);
  return after != ranges_.begin() && number < std::prev(after)->second;
}

std::int64_t RangeSet::size() const {
  std::int64_t count = 0;
  for (const auto& [begin, end] : ranges_) count += end - begin;
  return count;
}

}  // namespace selvage::fuzz
