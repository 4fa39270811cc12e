// The collisions of a whole mesh against exact arithmetic, as a part of a campaign (K1 to K3, K6).
#pragma once

#include <memory>

#include "fuzz/campaign/property.h"

namespace selvage::fuzz {

/// A stream for each class of surfaces. A case is a mesh and a motion.
[[nodiscard]] std::unique_ptr<Property> make_collisions_campaign();

}  // namespace selvage::fuzz
