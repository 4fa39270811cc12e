// Triangles that were one polygon: readers split it into a fan around its first corner.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "io/mesh_data.h"
#include "io/sequence.h"
#include "verify/check.h"

namespace selvage::cli {

/// Whether the two faces go around one corner in a row, as those of a polygon do. Those of a convex one have no overlap.
[[nodiscard]] bool is_of_one_fan(const io::Triangles& triangles, const std::array<std::int32_t, 2>& faces);

/// What to do about two of them that overlap.
[[nodiscard]] std::string fan_remedy(const std::array<std::int32_t, 2>& faces);

/// The remedy for the first violation of a frame that may come of polygons that were split, if there is one.
[[nodiscard]] std::optional<std::string> note_on_polygons(const io::SequenceReader& sequence,
                                                          const verify::SequenceReport& report);

}  // namespace selvage::cli
