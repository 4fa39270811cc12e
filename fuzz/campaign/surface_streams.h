// Surfaces as streams of a campaign: one for every class, by its name.
#pragma once

#include <cstdint>
#include <vector>

#include "fuzz/campaign/property.h"

namespace selvage::fuzz {

/// What each stands for is surface_class() of its name.
[[nodiscard]] std::vector<Stream> surface_streams(std::int64_t per_unit);

}  // namespace selvage::fuzz
