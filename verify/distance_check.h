// The minimum distance of a frame's features: as a part of check_frame, and by itself.
#pragma once

#include <span>
#include <vector>

#include "verify/check.h"

namespace selvage::verify {

class Tally;

/// Counts and records, as "near", the vertex-face and edge-edge pairs without a common vertex that are closer than
/// `distance`. Throws std::invalid_argument where it is negative or not finite.
void check_distances(const Topology& topology, std::span<const Point> V, double distance, const CheckOptions& options,
                     Tally& tally);

/// All that check_frame calls "near" for that minimum distance, in (event, features) order. Throws as both do.
[[nodiscard]] std::vector<Violation> near_pairs(const Topology& topology, std::span<const Point> V, double distance);

}  // namespace selvage::verify
