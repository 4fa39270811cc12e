// From a counted hit to the violation that is reported.
#pragma once

#include "verify/check.h"
#include "verify/tally.h"

namespace selvage::verify {

/// The corners in their order, from v on.
[[nodiscard]] std::array<std::int32_t, 3> corner_first(const std::array<std::int32_t, 3>& face, std::int32_t v);

/// Everything but frame, motion, time and positions.
[[nodiscard]] Violation describe(const Topology& topology, const Hit& hit);
/// Its vertices' positions; at the first touch they are rounded, as the time is. For a frame both ends are the frame.
void set_positions(Violation& violation, std::span<const Point> V_t0, std::span<const Point> V_t1);

}  // namespace selvage::verify
