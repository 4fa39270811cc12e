// What contacts bear is forgotten where there is no room.
#pragma once

#include <span>

#include "kernel/candidates.h"
#include "sim/contact/surface_parts.h"
#include "sim/dynamics/contact_load.h"

namespace selvage::sim {

/// Leaves out the loads of all cloth that hangs together with a vertex `without_room`, by its faces or by pairs that
/// press: `pressed`, or those with a load. What presses without room would be learnt without end: sheets that jammed
/// after they had met at 100 m/s were thrown apart at 10^9 m/s. But what only lies on the same body keeps its loads:
/// six sheets at rest sank by an eighth of their height and trembled, because a body waited ten metres away. The first
/// `cloth_count` vertices are cloth. O(#V + pairs), nothing where all had room.
void forget_loads(std::span<const VertexId> without_room, const Candidates& pressed, const Mesh& mesh,
                  const SurfaceParts& parts, VertexId cloth_count, ContactLoads& loads);

}  // namespace selvage::sim
