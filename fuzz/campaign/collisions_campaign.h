// The kernel's whole-mesh answer against exact arithmetic, as a part of a campaign: what no query alone can see (K1 to
// K3).
#pragma once

#include <memory>

#include "fuzz/campaign/property.h"

namespace selvage::fuzz {

[[nodiscard]] std::unique_ptr<Property> make_collisions_campaign();

}  // namespace selvage::fuzz
