// Positions as the numbers of a binary file, float64 or float32, never rounded by the way.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "io/error.h"
#include "io/mesh_data.h"

namespace selvage::io {

/// Appends x, y, z of every point, little endian. Throws Error(kBadInput) naming `name` and the vertex where
/// `precision` is float32 and a value is not exactly one.
void append_points(std::string& bytes, const Points& points, Precision precision, const std::string& name);

/// The first vertex of which a coordinate is not finite.
[[nodiscard]] std::optional<std::size_t> first_not_finite(const Points& points);

/// What rounding to float32 did.
struct Rounding {
  std::int64_t values = 0, changed = 0;
  double largest_change = 0;  ///< |rounded - original|: exact, the two being within a factor of two or one being zero
};

/// Rounds every coordinate to the nearest float32, ties to even, and adds to `rounding`. Throws Error(kBadInput) where
/// that is infinity.
void round_to_float32(Points& points, Rounding& rounding, const std::string& name);

}  // namespace selvage::io
