// What a step's report must name (S2), by the exact check.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "kernel/collisions.h"
#include "verify/check.h"

namespace selvage::fuzz {

[[nodiscard]] std::vector<verify::Point> raw_points(const Positions& x);

/// The pairs that are nearer than `distance`, exactly, in order.
[[nodiscard]] std::vector<verify::Violation> near_pairs(const verify::Topology& topology, const Positions& x,
                                                        double distance);

/// Whether `named` has every one of the pairs `near`.
[[nodiscard]] bool all_are_named(std::span<const verify::Violation> near, std::span<const Collision> named);

}  // namespace selvage::fuzz
