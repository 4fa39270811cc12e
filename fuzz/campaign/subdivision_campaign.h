// Subdivision of frames as a part of a campaign: what starts free of intersections stays so.
#pragma once

#include <memory>

#include "fuzz/campaign/property.h"

namespace selvage::fuzz {

/// A stream for each class of surfaces of the collision step, and one that smoothing would drive into itself. A case is
/// a surface, subdivided once or twice; judged are the motion from the midpoints of edges, which lie on the surface,
/// and the result, exactly.
[[nodiscard]] std::unique_ptr<Property> make_subdivision_campaign();

}  // namespace selvage::fuzz
