// A triangle mesh's connectivity. Positions are passed beside it, so that a step swaps them without a copy.
#pragma once

#include <array>
#include <limits>
#include <span>
#include <vector>

#include "kernel/input_error.h"
#include "kernel/types.h"

namespace selvage {

/// An edge number must be able to count three sides a face.
inline constexpr std::int32_t kMaxFaceCount = std::numeric_limits<EdgeId>::max() / 3;

/// What make_mesh() builds; not to be changed afterwards.
struct Mesh {
  std::int32_t vertex_count = 0;               ///< #V
  std::vector<std::array<VertexId, 3>> faces;  ///< #F, corners in the caller's order
  /// Unique, edge[0] < edge[1], sorted by (larger, smaller) vertex: the numbering of the public query sets.
  std::vector<std::array<VertexId, 2>> edges;
  /// face_edges[f][k] is the edge opposite to corner k of face f.
  std::vector<std::array<EdgeId, 3>> face_edges;
  /// The face that reports a feature, so that no pair is reported twice: the lowest-numbered one that holds it.
  /// -1 for a vertex that no face holds: it is no part of the surface and takes part in nothing.
  std::vector<FaceId> vertex_owner;
  std::vector<FaceId> edge_owner;  ///< likewise; every edge has one
};

/// Whether F (#F by 3) indexes vertices 0 .. vertex_count-1, no face repeats a vertex, and edge numbers fit. O(#F). A
/// negative vertex_count has no vertices to index: kIndexOutOfRange.
[[nodiscard]] InputError validate_faces(std::int32_t vertex_count, const FacesRef& F);

/// Builds edges and ownership; depends on indices alone. O(#F log #F). REQUIRES validate_faces() == kNone. Non-manifold
/// edges, duplicate faces, holes and loose vertices are valid.
[[nodiscard]] Mesh make_mesh(std::int32_t vertex_count, const FacesRef& F);
/// Of a list of faces. The same otherwise.
[[nodiscard]] Mesh make_mesh(std::int32_t vertex_count, std::span<const std::array<VertexId, 3>> faces);

/// First thing wrong with the positions of a step, V_t0 before V_t1, or kNone. O(#V). Zero-area faces and coincident
/// vertices are valid.
[[nodiscard]] InputError validate(const Mesh& mesh, const PositionsRef& V_t0, const PositionsRef& V_t1);

}  // namespace selvage
