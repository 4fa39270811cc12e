// How close a frame comes to touching.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "verify/check.h"

namespace selvage::verify {

/// The smallest distance of a vertex and a face that does not hold it, or of two edges without a common vertex, over
/// all pairs that the check owes (bodies and exemptions as there). 0 where they touch. Nothing where there is no such
/// pair. `upper` is the smallest double that is not below the exact distance, `lower` the largest that is not above;
/// the pair is a nearest one, exactly, and the first such in (event, features) order. Costs some ten times
/// as much as check_frame: 10 for wavy, 10 to 32 for flat sheets of 180,000 faces. Throws std::invalid_argument as
/// check_frame does, and Stopped.
[[nodiscard]] std::optional<Gap> smallest_gap(const Topology& topology, std::span<const Point> V,
                                              const CheckOptions& options);

/// Of the exact distances, also where both lie between the same doubles.
[[nodiscard]] bool is_smaller(const Gap& a, const Gap& b);

}  // namespace selvage::verify
