// A surface that is subdivided as a case (paper, section 8).
#pragma once

#include "fuzz/kept/mesh_case.h"
#include "io/mesh_data.h"

namespace selvage::fuzz {

[[nodiscard]] const MeshKind& subdivision_kind();
/// `is_scripted`, #V: 1 for vertices of bodies; a face that has no other is a body's.
[[nodiscard]] MeshCase subdivision_case(const io::Triangles& faces, const Positions& x,
                                        const std::vector<double>& is_scripted, int levels);

struct SubdivisionTrial {
  std::int64_t levels = 0;   ///< done and judged
  std::int64_t stopped = 0;  ///< levels at which a vertex had to stop
  bool is_rounded = false;   ///< the midpoints, rounded, intersect: what follows is not promised
  Retrial retrial;
};
/// Level by level: the midpoints, the motion from there to the smooth places, and what is there, all exactly. REQUIRES
/// that the start is free of intersections.
[[nodiscard]] SubdivisionTrial try_subdivision(const MeshCase& kept);

}  // namespace selvage::fuzz
