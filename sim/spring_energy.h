// What springs hold.
#pragma once

#include "sim/spring.h"

namespace selvage::sim {

/// Elastic energy of the springs at x, J; 0 without springs. O(springs), in parallel, same bits for any thread count.
[[nodiscard]] double elastic_energy_j(const SpringSystem& springs, const PositionsRef& x);

}  // namespace selvage::sim
