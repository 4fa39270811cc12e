// Whether contact strains the springs that it holds: where a collision step is long beside the swing of the springs,
// the dynamics carries a vertex on in it that contact then puts back, and the springs between are pressed.
#pragma once

#include <cstdint>

#include "sim/spring.h"

namespace selvage::sim {

/// Structural and shear springs that end beyond 1.5 strain limits and are strained by more than at the start, by a
/// fifth of the limit or more. 0 without a limit. O(springs), in parallel.
[[nodiscard]] std::int64_t springs_overstrained(const SpringSystem& springs, double strain_limit,
                                                const PositionsRef& x_t0, const PositionsRef& x_t1);

}  // namespace selvage::sim
