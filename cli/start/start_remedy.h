// What to do about a start that intersects: faults of the meshes themselves, which moving cloth apart does not mend.
#pragma once

#include <span>
#include <string>

#include "sim/repair/start_repair.h"
#include "sim/world.h"

namespace selvage::cli {

/// The remedy for `pairs`, which intersect at `x`. What is wrong with a mesh is named first: faces without area, the
/// same face twice, a polygon that is not convex, a seam along which the mesh is split. With `repair_failed` nothing
/// else is left but to move them apart by hand.
[[nodiscard]] std::string start_remedy(const sim::World& world, const Positions& x,
                                       std::span<const sim::FacePair> pairs, bool repair_failed);

/// Of such a start that a repair has freed: what was wrong with the mesh, as a polygon that is laid out otherwise now,
/// or seams that are open; or nothing.
[[nodiscard]] std::string note_on_freed(const sim::World& world, const Positions& x,
                                        std::span<const sim::FacePair> pairs);

}  // namespace selvage::cli
