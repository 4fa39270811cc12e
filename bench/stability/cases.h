// The cases by theme; a file each.
#pragma once

#include <vector>

#include "bench/stability/suite.h"

namespace selvage::bench {

[[nodiscard]] std::vector<StabilityCase> spike_cases();       ///< features without a normal: tips, ridges, cracks
[[nodiscard]] std::vector<StabilityCase> degenerate_cases();  ///< meshes and candidates that no one would draw

}  // namespace selvage::bench
