// Polygons as fans of triangles, the same for every mesh format.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "io/mesh_data.h"

namespace selvage::io {

/// Vertex and face numbers are int32 throughout.
inline constexpr std::size_t kMaxElements = std::numeric_limits<std::int32_t>::max();

/// Appends the fan (0, k, k+1) of the polygon, and counts it where it is split. Returns what is wrong with it, empty if
/// nothing: fewer than three corners, a repeated corner, more than kMaxElements triangles. O(n log n); `corners` is
/// used up.
[[nodiscard]] std::string append_fan(std::vector<std::int32_t>& corners, MeshData& mesh);

/// What a user should know where polygons were split, as a sentence; nothing where none was.
[[nodiscard]] std::string split_remark(const std::string& source, std::int64_t split_polygons);

}  // namespace selvage::io
