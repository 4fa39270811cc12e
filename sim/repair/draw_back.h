// Draws cloth back that has come through cloth, itself or another.
#pragma once

#include "sim/repair/untangle_state.h"

namespace selvage::sim {

/// What is tried, in this order, as long as it helps:
///   parts      a part that meets others moves as a whole along the normal of what it meets, by one gap, two, four, and
///              so on, until it meets none; approach_start() takes it back later;
///   regions    edges that cross a face are cut, and what hangs together without them is a region; it is drawn towards
///              the membrane that spans the ring of vertices around it, the solution of Laplace's equation on its
///              edges, which is in the convex hull of the ring and so on its side of a flat face. As much of the shape
///              is kept as can be: a half, a quarter, and so on; the region grows by a ring where that does not do;
///   crossings  the same with the vertices of the faces that cross, where the cuts leave no regions;
///   flat       a part with a border, none of it scripted, is laid out flat (flat_layout.h), with as much of its shape
///              as it can keep, aside where others are in the way; approach_start() takes it back later. The last
///              rounds are kept for it;
///   far        regions and crossings that grow by more rings, as of cloth that is pinned.
/// The smallest come first, without scripted vertices and the largest region of each part. A change on whose way cloth
/// meets a body is made where neither parts, regions nor crossings help without: two sheets that crossed above the
/// ground were parted through it, and one fell for ever. Flat and far come after that, so that what the others free
/// keeps its bits. A change is kept only if fewer pairs of cloth intersect, so this ends after as many changes as
/// there are pairs at most. Changes state.x; false where pairs of cloth remain.
[[nodiscard]] bool draw_cloth_back(UntangleState& state);

}  // namespace selvage::sim
