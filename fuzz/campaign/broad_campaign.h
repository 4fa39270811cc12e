// The broad phase against brute force, as a part of a campaign (K6).
#pragma once

#include <memory>

#include "fuzz/campaign/property.h"

namespace selvage::fuzz {

/// A stream for each class of surfaces. A case is a mesh and two motions in a row, found by every kind of hierarchy.
[[nodiscard]] std::unique_ptr<Property> make_broad_campaign();

}  // namespace selvage::fuzz
