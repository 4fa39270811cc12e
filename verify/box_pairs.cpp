#include "verify/box_pairs.h"

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

/// Morton code of the middle of a box; which code it is affects speed alone.
std::uint64_t morton_code(const LatticeBox& box) {
  std::uint64_t code = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::int64_t twice_middle = std::int64_t{box.min[k]} + box.max[k] + (std::int64_t{1} << 31);
    code |= spread(static_cast<std::uint64_t>(twice_middle) >> 11) << k;
  }
  return code;
}

}  // namespace

BoxTree::BoxTree(std::span<const Box> boxes, const Lattice& lattice) {
  if (boxes.empty()) return;
  struct Entry {
    std::uint64_t code;
    std::int32_t index;
    bool operator<(const Entry& other) const { return code != other.code ? code < other.code : index < other.index; }
  };
  const auto quantized = [&](const Box& box) {
    LatticeBox q{};
    for (std::size_t k = 0; k < 3; ++k) {
      q.min[k] = lattice(k, box.min[k]);
      q.max[k] = lattice(k, box.max[k]);
    }
    return q;
  };
  // All threads must round alike: boxes are compared on the lattice only.
  const auto for_each_block = [&](const auto& function) {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, (boxes.size() + kWidth - 1) / kWidth),
                      [&](const tbb::blocked_range<std::size_t>& blocks) {
                        const FpGuard guard;
                        const std::size_t end = std::min(blocks.end() * kWidth, boxes.size());
                        for (std::size_t i = blocks.begin() * kWidth; i < end; ++i) function(i);
                      });
  };
  std::vector<Entry> entries(boxes.size());
  for_each_block([&](std::size_t i) { entries[i] = {morton_code(quantized(boxes[i])), static_cast<std::int32_t>(i)}; });
  tbb::parallel_sort(entries.begin(), entries.end());

  boxes_.resize(boxes.size());
  order_.resize(boxes.size());
  levels_.emplace_back((boxes.size() + kWidth - 1) / kWidth);
  for_each_block([&](std::size_t i) {
    order_[i] = entries[i].index;
    boxes_[i] = boxes[static_cast<std::size_t>(entries[i].index)];
    levels_.front()[i / kWidth].set(i % kWidth, quantized(boxes_[i]));
  });
  for (const BoxBlock& block : levels_.front()) block_bounds_.push_back(block.bounds());
  while (levels_.back().size() > 1) {
    const std::vector<BoxBlock>& below = levels_.back();
    std::vector<BoxBlock> level((below.size() + kWidth - 1) / kWidth);
    for (std::size_t i = 0; i < below.size(); ++i) level[i / kWidth].set(i % kWidth, below[i].bounds());
    levels_.push_back(std::move(level));
  }
}

}  // namespace selvage::verify
