// Where a vertex is, as the checker takes it: stored doubles.
#pragma once

#include <array>
#include <cmath>
#include <stdexcept>
#include <string>

#include "verify/arithmetic/sound_arithmetic.h"

namespace selvage::verify {

using Point = std::array<double, 3>;

/// Throws std::invalid_argument, in the name of what was asked, where a coordinate is not finite.
template <std::size_t N>
void require_finite(const std::array<Point, N>& points, const char* asked) {
  for (const Point& point : points) {
    // Not by an algorithm, whose loop takes g++ 12 twice the instructions: an eighth of what a filter's decision takes.
    if (!(std::isfinite(point[0]) && std::isfinite(point[1]) && std::isfinite(point[2]))) {
      throw std::invalid_argument(std::string(asked) + ": a coordinate is not finite");
    }
  }
}

}  // namespace selvage::verify
