// Which work units are done: a set of numbers that are mostly neighbours, but in a shard of a campaign, where none are.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

namespace selvage::fuzz {

class RangeSet {
 public:
  /// Half-open, ascending, not touching each other.
  using Ranges = std::vector<std::pair<std::int64_t, std::int64_t>>;

  RangeSet() = default;
  /// False, and left as it was, where the number is in the set already.
  bool insert(std::int64_t number) { return insert(number, number + 1); }
  bool insert(std::int64_t begin, std::int64_t end);
  /// O(log of the number of ranges).
  [[nodiscard]] bool contains(std::int64_t number) const;
  [[nodiscard]] std::int64_t size() const;
  [[nodiscard]] const Ranges& ranges() const { return ranges_; }
  friend bool operator==(const RangeSet&, const RangeSet&) = default;

 private:
  Ranges ranges_;
};

}  // namespace selvage::fuzz
