#include "kernel/broad/words.h"

#include <algorithm>
#include <array>
#include <bit>
#include <numeric>

namespace selvage {

namespace {

/// Below this, comparing beats counting (measured on the lists of the cloth-ball frame: equal at about 60 words).
constexpr std::size_t kCountingSortMin = 64;
/// 2^10 counters are cleared and summed in about the time it takes to move a list of typical length, 500 words.
constexpr int kDigitBitsMax = 10;

}  // namespace

Words::Words(std::initializer_list<std::uint64_t> words) { assign(std::span(words.begin(), words.size())); }

void Words::assign(std::span<const std::uint64_t> words) {
  clear();
  std::copy(words.begin(), words.end(), room(words.size()));
  keep(words.size());
}

void Words::push_back(std::uint64_t word) {
  *room(1) = word;
  keep(1);
}

std::uint64_t* Words::room(std::size_t count) {
  if (size_ + count > capacity_) {
    capacity_ = std::max(size_ + count, 2 * capacity_);
    auto larger = std::make_unique_for_overwrite<std::uint64_t[]>(capacity_);
    std::copy_n(data_.get(), size_, larger.get());
    data_ = std::move(larger);
  }
  return data_.get() + size_;
}

void Words::sort_by_high_half(Words& spare) {
  if (size_ < kCountingSortMin) {
    std::sort(begin(), end());
    return;
  }
  // Radix sort over those low bits of the high halves in which words differ, in passes of equal width.
  std::uint64_t any = 0, all = ~std::uint64_t{0};
  for (const std::uint64_t word : *this) {
    any |= word;
    all &= word;
  }
  const int bits = static_cast<int>(std::bit_width((any ^ all) >> 32));
  const int pass_count = (bits + kDigitBitsMax - 1) / kDigitBitsMax;
  const int digit_bits = (bits + pass_count - 1) / pass_count;
  const std::size_t digit_count = std::size_t{1} << digit_bits;
  std::array<std::size_t, std::size_t{1} << kDigitBitsMax> place;
  for (int pass = 0; pass < pass_count; ++pass) {
    const auto digit = [&](std::uint64_t word) { return (word >> (32 + pass * digit_bits)) & (digit_count - 1); };
    std::fill_n(place.begin(), digit_count, 0);
    for (const std::uint64_t word : *this) ++place[digit(word)];
    std::exclusive_scan(place.begin(), place.begin() + static_cast<std::ptrdiff_t>(digit_count), place.begin(),
                        std::size_t{0});
    spare.clear();
    std::uint64_t* const sorted = spare.room(size_);
    for (const std::uint64_t word : *this) sorted[place[digit(word)]++] = word;
    spare.keep(size_);
    std::swap(*this, spare);
  }
}

}  // namespace selvage
