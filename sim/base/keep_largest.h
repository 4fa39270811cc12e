// The largest of some numbers, one of which may be none.
#pragma once

#include <cmath>

namespace selvage::sim {

/// Raises `largest` to `value`. NaN stays: what has left the doubles once is not hidden by what follows.
inline void keep_largest(double value, double& largest) {
  if (std::isnan(value) || value > largest) largest = value;
}

}  // namespace selvage::sim
