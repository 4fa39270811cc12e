// Memory for the pairs that one thread finds: it grows without moving them.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace selvage {

/// Pairs are words: the first feature in the low half, the second in the high half.
class PairBuffer {
 public:
  /// Room for `count` words, valid until the next call.
  std::uint64_t* room(std::size_t count) {
    if (left_ < count) {
      left_ = std::max(count, kChunk);
      chunks_.push_back(std::make_unique_for_overwrite<std::uint64_t[]>(left_));
      next_ = chunks_.back().get();
    }
    return next_;
  }
  /// Keeps the first `count` words of the room.
  std::span<const std::uint64_t> keep(std::size_t count) {
    const std::span<const std::uint64_t> kept(next_, count);
    next_ += count;
    left_ -= count;
    return kept;
  }

  /// Gives back what was kept last.
  void give_back(std::span<const std::uint64_t> kept) {
    next_ -= kept.size();
    left_ += kept.size();
  }

 private:
  static constexpr std::size_t kChunk = 1 << 16;  ///< 512 KB: few allocations, little left over
  std::vector<std::unique_ptr<std::uint64_t[]>> chunks_;
  std::uint64_t* next_ = nullptr;
  std::size_t left_ = 0;
};

}  // namespace selvage
