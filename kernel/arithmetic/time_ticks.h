// Times as whole numbers of ticks, so that both t and 1 - t are exact doubles.
#pragma once

#include <cstdint>

namespace selvage::detail {

using Tick = std::uint64_t;
inline constexpr Tick kTicks = Tick{1} << 52;  ///< in the whole step

inline double time_of(Tick tick) { return static_cast<double>(tick) * 0x1p-52; }

struct TickInterval {
  Tick begin = 0, end = 0;
};

}  // namespace selvage::detail
