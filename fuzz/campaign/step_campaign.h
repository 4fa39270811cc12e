// The collision step under hostile candidates, as a part of a campaign (S1 to S4).
#pragma once

#include <memory>

#include "fuzz/campaign/property.h"

namespace selvage::fuzz {

/// A stream for each class of surfaces. A case is a world and one to four steps, each judged exactly.
[[nodiscard]] std::unique_ptr<Property> make_step_campaign();

}  // namespace selvage::fuzz
