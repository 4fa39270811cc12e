// The minimum distance of a frame's features: part of check_frame.
#pragma once

#include <span>

#include "verify/check.h"
#include "verify/tally.h"

namespace selvage::verify {

/// Counts and records, as "near", the vertex-face and edge-edge pairs without a common vertex that are closer than
/// `distance`. Throws std::invalid_argument where it is negative or not finite.
void check_distances(const Topology& topology, std::span<const Point> V, double distance, const CheckOptions& options,
                     Tally& tally);

}  // namespace selvage::verify
