// What limits on strain may make of vertices that scripts move against each other.
#pragma once

#include <vector>

#include "sim/base/lane_vectors.h"
#include "sim/springs/impulse_projection.h"

namespace selvage::sim {

/// Impulses of pairs take kinetic energy away, but for what the vertices with inverse mass 0 put in where they move
/// against each other. Two of them that squeeze a chain of pairs that is nearly straight put in what they like: only
/// what is across the chain lets the pairs keep their bounds, so 2 m/s make 60 m/s of it (the toggle of a press). So of
/// each set of pairs that share vertices, the changes are taken as far as none of these is faster than it may be,
/// beside the mean of those that are moved: as fast as the fastest was, or as twice the fastest of those. Shortens
/// `change_n_s` and `impulse_n_s`; v holds what the impulses have not changed yet. Sets in which nothing is moved, or
/// all alike, are left as they are. O(pairs log pairs) where something is.
void limit_drive(const LaneVectors& v, std::vector<BoundedPair>& pairs);

}  // namespace selvage::sim
