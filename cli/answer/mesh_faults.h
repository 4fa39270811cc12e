// What is wrong with a mesh itself where two of its faces intersect: a polygon that was split into a fan around its
// first corner and is not convex, or a seam along which vertices lie at one place.
#pragma once

#include <array>
#include <optional>
#include <set>
#include <string>

#include "io/mesh_data.h"
#include "io/sequence.h"
#include "verify/check.h"

namespace selvage::cli {

/// Whether the two faces go around one corner in a row, as those of a polygon do. Those of a convex one have no
/// overlap.
[[nodiscard]] bool is_of_one_fan(const io::Triangles& triangles, const std::array<std::int32_t, 2>& faces);

/// What to do about two of them that overlap.
[[nodiscard]] std::string fan_remedy(const std::array<std::int32_t, 2>& faces);

/// Corners of either face that lie, to the bit, where one of the other face lies.
[[nodiscard]] std::set<std::int32_t> coincident_corners(const io::Triangles& triangles, const io::Points& x,
                                                        const std::array<std::int32_t, 2>& faces);

/// The remedy for the first violation of a frame that may come of polygons that were split, if there is one.
[[nodiscard]] std::optional<std::string> note_on_polygons(const io::SequenceReader& sequence,
                                                          const verify::SequenceReport& report);

}  // namespace selvage::cli
