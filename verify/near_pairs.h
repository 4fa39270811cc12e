// The pairs whose distance counts at one instant: vertex and face, or two edges, without a common vertex.
#pragma once

#include <span>
#include <utility>

#include "verify/part_trees.h"

namespace selvage::verify {

/// Calls visit(event, i, j, x, tally) for all pairs that the check owes and that may be within `distance`: their boxes,
/// grown by half of it, overlap. x: the vertex, then the corners of the face; or the ends of both edges. REQUIRES
/// distance >= 0.
template <class Visit>
void visit_near_pairs(const Topology& topology, std::span<const Point> V, double distance, bool check_bodies,
                      std::size_t limit, Tally& tally, const Visit& visit) {
  const auto at = [V](std::int32_t v) -> const Point& { return V[static_cast<std::size_t>(v)]; };
  const auto face = [&](std::int32_t f) { return topology.triangles[static_cast<std::size_t>(f)]; };
  const auto edge = [&](std::int32_t e) { return topology.edges[static_cast<std::size_t>(e)]; };
  const Lattices<1> lattice{Lattice::over(bulk_box(topology, V))};
  const double half = 0.5 * distance;  // each of two boxes grows by half
  const PartTrees<ElementTree<1>> vertices(topology.vertices, lattice, [&](std::int32_t v) {
    return Boxes<1>{grown({at(v), at(v)}, half)};
  });
  const PartTrees<ElementTree<1>> faces(topology.faces, lattice, [&](std::int32_t f) {
    const auto [a, b, c] = face(f);
    return Boxes<1>{grown(bounding_box(std::array{at(a), at(b), at(c)}), half)};
  });
  const PartTrees<ElementTree<1>> edges(topology.edge_parts, lattice, [&](std::int32_t e) {
    const auto [a, b] = edge(e);
    return Boxes<1>{grown(bounding_box(std::array{at(a), at(b)}), half)};
  });
  vertices.tally_between(faces, check_bodies, limit, tally, [&](Tally& chunk, std::int32_t v, std::int32_t f) {
    const auto [a, b, c] = face(f);
    if (v == a || v == b || v == c) return;
    if (chunk.is_exempt(topology, check_bodies, topology.vertex_labels, v, topology.face_labels, f)) return;
    visit(EventKind::kVf, v, f, std::array<Point, 4>{at(v), at(a), at(b), at(c)}, chunk);
  });
  edges.tally_within(check_bodies, limit, tally, [&](Tally& chunk, std::int32_t e, std::int32_t f) {
    if (f < e) std::swap(e, f);
    const auto [a, b] = edge(e);
    const auto [c, d] = edge(f);
    if (a == c || a == d || b == c || b == d) return;
    if (chunk.is_exempt(topology, check_bodies, topology.edge_labels, e, topology.edge_labels, f)) return;
    visit(EventKind::kEe, e, f, std::array<Point, 4>{at(a), at(b), at(c), at(d)}, chunk);
  });
}

}  // namespace selvage::verify
