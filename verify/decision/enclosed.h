// Exact decision whether a closed surface encloses a point.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "verify/arithmetic/point.h"

namespace selvage::verify {

/// Whether a ray from the point upwards (the third axis) crosses an odd number of the faces, exactly, whatever vertices
/// and edges it runs through: which way round faces are does not matter, and what a surface encloses twice counts as
/// outside. REQUIRES that an even number of the faces hold each edge, indices within V, finite positions, and the point
/// on none of the faces. O(#F).
[[nodiscard]] bool is_enclosed(const Point& point, std::span<const std::array<std::int32_t, 3>> faces,
                               std::span<const Point> V);

}  // namespace selvage::verify
