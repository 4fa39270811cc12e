// Positions as files and the exact checker take them.
#pragma once

#include "io/mesh_data.h"
#include "kernel/types.h"

namespace selvage::sim {

/// The same bits, row by row.
[[nodiscard]] io::Points points_of(const Positions& x);

/// Bit for bit, so that a position that is no number equals itself.
[[nodiscard]] bool same_bits(const Positions& a, const Positions& b);

}  // namespace selvage::sim
