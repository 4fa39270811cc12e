// Cloth that is wholly inside a body where a run starts: it meets nothing, so nothing else says so.
#pragma once

#include <string>
#include <vector>

#include "sim/world.h"

namespace selvage::cli {

/// A sentence for each cloth and each closed body with a connected part of the cloth inside a connected part of the
/// body; decided exactly. A part of a body is closed where an even number of its faces hold each edge. O(#F), and the
/// faces of a body's part once for each part of cloth whose box is in its: 11 ms beside the 615 ms of a start of
/// 180,000 faces inside a body of 330,000, 0.1 beside 10 ms where no box is in another. REQUIRES that no cloth meets a
/// body.
[[nodiscard]] std::vector<std::string> notes_on_enclosed(const sim::World& world, const Positions& x);

}  // namespace selvage::cli
