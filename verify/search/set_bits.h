// What a byte says about eight things, looked up: processors of the baseline have no instruction for it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace selvage::verify {

/// How many bits are set.
inline constexpr auto kBitCount = [] {
  std::array<std::uint8_t, 256> counts{};
  for (std::size_t i = 1; i < counts.size(); ++i) counts[i] = static_cast<std::uint8_t>(counts[i / 2] + i % 2);
  return counts;
}();

/// Which ones, in ascending order, and zeros behind them. Copying all eight and counting those that are set takes no
/// branch, whose way nobody could predict.
inline constexpr auto kSetBits = [] {
  std::array<std::array<std::uint8_t, 8>, 256> places{};
  for (std::size_t mask = 0; mask < places.size(); ++mask) {
    std::size_t count = 0;
    for (std::uint8_t bit = 0; bit < 8; ++bit) {
      if ((mask >> bit & 1U) != 0) places[mask][count++] = bit;
    }
  }
  return places;
}();

}  // namespace selvage::verify
