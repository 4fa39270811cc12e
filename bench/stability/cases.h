// The cases by theme; a file each.
#pragma once

#include <vector>

#include "bench/stability/suite.h"

namespace selvage::bench {

[[nodiscard]] std::vector<StabilityCase> spike_cases();       ///< features without a normal: tips, ridges, cracks
[[nodiscard]] std::vector<StabilityCase> degenerate_cases();  ///< meshes and candidates that no one would draw
[[nodiscard]] std::vector<StabilityCase> layer_cases();       ///< parallel, coplanar and turning layers
[[nodiscard]] std::vector<StabilityCase> squeeze_cases();     ///< cloth between scripted bodies
[[nodiscard]] std::vector<StabilityCase> needle_cases();      ///< long and thin
[[nodiscard]] std::vector<StabilityCase> tie_cases();         ///< exact touches, everything aligned
[[nodiscard]] std::vector<StabilityCase> scale_cases();       ///< units, offsets, lattices, the ends of the range
[[nodiscard]] std::vector<StabilityCase> fold_cases();        ///< cloth against itself
[[nodiscard]] std::vector<StabilityCase> rest_cases();        ///< cloth that rests or slides on a body
[[nodiscard]] std::vector<StabilityCase> twist_cases();       ///< twisted and knotted
[[nodiscard]] std::vector<StabilityCase> long_cases();        ///< cloth pulled and pressed, in whole simulations
[[nodiscard]] std::vector<StabilityCase> input_cases();       ///< what must be refused

}  // namespace selvage::bench
