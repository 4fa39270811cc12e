// What numbers of a scene may be: of its file, and of the mesh files that it names. Internal to reading and building.
#pragma once

#include <cmath>
#include <limits>

namespace selvage::sim {

/// Admissible values: lower <= x <= upper, or lower < x where the lower end is open.
struct Range {
  double lower = -std::numeric_limits<double>::max(), upper = std::numeric_limits<double>::max();
  bool lower_open = false;
};
inline constexpr Range kPositive{0, 1e30, true};
inline constexpr Range kNotNegative{0, 1e30};
/// Scripted and initial coordinates: beyond it 1e-6 m is below the spacing of doubles, and no tolerance means anything.
inline constexpr Range kCoordinate{-1e9, 1e9};
/// Sizes; with those above, their areas, masses and squares stay far within doubles.
inline constexpr Range kLength{1e-30, 1e9};
/// Of a frame: no step is shorter. More of them than that are no simulation that anyone waits for.
inline constexpr double kLeastStepShare = 1e-6;
/// The longest collision step of the implicit solver where the scene gives none. Where contacts are that solver is of
/// first order, and what is pressed anew costs it solutions: in steps of 1/24 s a shirt on a figure that turns and
/// leans hung 17 cm too high after half a second, for 2.5 times the time (docs/measurements/numerics.md).
inline constexpr double kLongestImplicit_s = 1.0 / 192;

[[nodiscard]] inline bool inside(double value, const Range& range) {
  return std::isfinite(value) && (range.lower_open ? value > range.lower : value >= range.lower) &&
         value <= range.upper;
}

}  // namespace selvage::sim
