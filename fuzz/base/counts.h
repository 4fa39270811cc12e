// What the cases of a campaign come to.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace selvage::fuzz {

/// Sums, and one maximum: joining is associative and commutative, so that any division of the work gives the same
/// total. Plain data, because it lives in memory that processes share.
struct Counts {
  static constexpr std::size_t kCounters = 8;

  std::int64_t cases = 0, failures = 0;
  std::array<std::int64_t, kCounters> of{};  ///< as Property::counters names them
  std::int64_t nearest_bits = 0;             ///< the nearest miss: bits of size / gap; the larger, the sharper

  Counts& operator+=(const Counts& other) {
    cases += other.cases;
    failures += other.failures;
    for (std::size_t i = 0; i < kCounters; ++i) of[i] += other.of[i];
    nearest_bits = std::max(nearest_bits, other.nearest_bits);
    return *this;
  }
  friend bool operator==(const Counts&, const Counts&) = default;
};

}  // namespace selvage::fuzz
