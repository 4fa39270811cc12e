// Whole simulations of random scenes, every step checked exactly, as a part of a campaign (S1, S4).
#pragma once

#include <memory>

#include "fuzz/campaign/property.h"

namespace selvage::fuzz {

/// A case is a scene and some tens of steps. Each frame and each motion between two is decided exactly.
[[nodiscard]] std::unique_ptr<Property> make_simulation_campaign();

}  // namespace selvage::fuzz
