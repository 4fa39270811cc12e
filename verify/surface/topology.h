// What a check needs to know about a surface besides positions: its edges, and what belongs to cloth and to bodies.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "verify/search/box_block.h"
#include "verify/surface/exemptions.h"

namespace selvage::verify {

/// The surface: triangles and, per face, whether it belongs to a scripted body (empty: none does) and whether it is no
/// part of the check (empty: all are).
struct Surface {
  std::span<const std::array<std::int32_t, 3>> triangles;
  std::span<const std::uint8_t> is_body = {};
  std::span<const std::uint8_t> is_ignored = {};
  std::span<const Exemption> exemptions = {};
  /// Per vertex the one that it is the same as (Weld); empty: itself. Edges and vertices are those of the
  /// representatives. A face of which two corners are the same has fewer, and they are all of it: it is the union of
  /// them.
  std::span<const std::int32_t> representatives = {};
};

/// Indices of elements, ascending, by whom they belong to. An edge or vertex of any cloth face belongs to cloth; what
/// only ignored faces hold is in neither part.
struct Parts {
  std::vector<std::int32_t> cloth, body;
};

struct Topology {
  std::vector<std::array<std::int32_t, 3>> triangles;
  std::vector<std::array<std::int32_t, 2>> edges;  ///< {smaller, larger} vertex, sorted by (larger, smaller)
  Parts faces, edge_parts, vertices;
  std::int64_t vertex_count = 0;
  std::int64_t unreferenced_vertices = 0;  ///< held by no face: in neither part
  ExemptionTable exemptions;
  std::vector<Label> face_labels, edge_labels, vertex_labels;  ///< empty where there are no exemptions
};

/// Throws std::invalid_argument where an index is out of range, a face that is not ignored repeats a corner or does not
/// name the representatives of its corners, is_body or is_ignored have another length than the faces, representatives
/// another one than the vertices, or ExemptionTable does. O(#F log #F).
[[nodiscard]] Topology make_topology(const Surface& surface, std::size_t vertex_count);

/// Whether any two faces are owed a check: not ignored, not both of bodies unless asked for, and not exempt.
[[nodiscard]] bool owes_pairs(const Topology& topology, bool check_bodies);

/// The smallest box that holds the vertices of both parts, but for those that are many times farther away than most; of
/// none, the origin. Trees span it: a vertex far away, as of a simulation that blew up, would leave everything else in
/// one cell. O(#V).
[[nodiscard]] Box bulk_box(const Topology& topology, std::span<const Point> V);

/// Throws std::invalid_argument unless there are `topology.vertex_count` points and all are finite: no verdict is
/// given on others.
void require_positions(const Topology& topology, std::span<const Point> V);

}  // namespace selvage::verify
