// The faces of a body as one surface. Which pairs of features are contacts is told by what they share
// (local_proximities.h), and what lies at one place but has two names shares nothing: over a flat ground of separate
// triangles cloth stumbled at every edge, up to 56 mm high.
#pragma once

#include <cstdint>
#include <span>

#include "io/mesh_data.h"
#include "kernel/types.h"

namespace selvage::sim {

struct JoinedFaces {
  io::Triangles triangles;
  std::int32_t joined_vertices = 0;  ///< that had a face and have none now
  std::int32_t left_out = 0;         ///< faces
};

/// `triangles` with each corner named by the first vertex at its place (OnePlace). A face that comes to name a vertex
/// twice is a segment, or a point, for all time. It is left out where that is one of the edges, or vertices, of a face
/// that stays: nothing that is there is lost, and no edge is held by an odd number of faces for it. Where it stands
/// alone it stays, to stop cloth, and the later of its corners at one place keep their own names. O(#V + #F), log of
/// the number of such faces for each edge where there are any. REQUIRES faces that name no vertex twice.
[[nodiscard]] JoinedFaces join_faces(const io::Triangles& triangles, std::span<const VertexId> first);

}  // namespace selvage::sim
