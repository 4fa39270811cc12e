// Where a vertex is, as the checker takes it: stored doubles.
#pragma once

#include <array>

namespace selvage::verify {

using Point = std::array<double, 3>;

}  // namespace selvage::verify
