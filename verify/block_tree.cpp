#include "verify/block_tree.h"

#include <utility>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include "verify/fp_guard.h"

namespace selvage::verify {
namespace {

/// The lowest 21 bits of x, two zeros after each.
std::uint64_t spread(std::uint64_t x) {
  x &= 0x1fffff;
  x = (x | x << 32) & 0x001f00000000ffff;
  x = (x | x << 16) & 0x001f0000ff0000ff;
  x = (x | x << 8) & 0x100f00f00f00f00f;
  x = (x | x << 4) & 0x10c30c30c30c30c3;
  x = (x | x << 2) & 0x1249249249249249;
  return x;
}

}  // namespace

std::uint64_t morton_code(const std::array<std::int32_t, 3>& point) {
  std::uint64_t code = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::int64_t from_zero = std::int64_t{point[k]} + (std::int64_t{1} << 31);
    code |= spread(static_cast<std::uint64_t>(from_zero) >> 11) << k;
  }
  return code;
}

std::vector<std::int32_t> order_by_code(std::size_t count, const std::function<std::uint64_t(std::size_t)>& code) {
  struct Entry {
    std::uint64_t code;
    std::int32_t index;
    bool operator<(const Entry& other) const { return code != other.code ? code < other.code : index < other.index; }
  };
  std::vector<Entry> entries(count);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count), [&](const auto& range) {
    const FpGuard guard;
    for (std::size_t i = range.begin(); i < range.end(); ++i) entries[i] = {code(i), static_cast<std::int32_t>(i)};
  });
  tbb::parallel_sort(entries.begin(), entries.end());
  std::vector<std::int32_t> order(count);
  std::transform(entries.begin(), entries.end(), order.begin(), [](const Entry& entry) { return entry.index; });
  return order;
}

BlockTree::BlockTree(std::span<const LatticeBox> bounds) {
  if (bounds.empty()) return;
  levels_.emplace_back((bounds.size() + kWidth - 1) / kWidth);
  for (std::size_t i = 0; i < bounds.size(); ++i) levels_.front()[i / kWidth].set(i % kWidth, bounds[i]);
  while (levels_.back().size() > 1) {
    const std::vector<BoxBlock>& below = levels_.back();
    std::vector<BoxBlock> level((below.size() + kWidth - 1) / kWidth);
    for (std::size_t i = 0; i < below.size(); ++i) level[i / kWidth].set(i % kWidth, below[i].bounds());
    levels_.push_back(std::move(level));
  }
}

}  // namespace selvage::verify
