// The last step of a repair: back towards where the cloth was.
#pragma once

#include "sim/repair/untangle_state.h"

namespace selvage::sim {

/// Certified steps towards where the cloth was, in which only what was moved moves. PRE: state.x is free of
/// intersections. POST: so it is still.
void approach_start(UntangleState& state);

}  // namespace selvage::sim
