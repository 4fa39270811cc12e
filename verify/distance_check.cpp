#include "verify/distance_check.h"

#include <cmath>
#include <stdexcept>
#include <utility>

#include "verify/distance_filter.h"
#include "verify/exact_distance.h"
#include "verify/part_trees.h"

namespace selvage::verify {
namespace {

std::size_t at(std::int32_t index) { return static_cast<std::size_t>(index); }

}  // namespace

void check_distances(const Topology& topology, std::span<const Point> V, double distance, const CheckOptions& options,
                     Tally& tally) {
  if (!(distance >= 0) || !std::isfinite(distance)) {
    throw std::invalid_argument("the minimum distance must be finite and not negative");
  }
  if (V.empty()) return;
  const Lattice lattice = Lattice::over(bounding_box(V));
  const double half = 0.5 * distance;  // each of two boxes grows by half
  const PartTrees vertices(topology.vertices, lattice, [&](std::int32_t v) {
    return grown({V[at(v)], V[at(v)]}, half);
  });
  const PartTrees faces(topology.faces, lattice, [&](std::int32_t f) {
    const auto& [a, b, c] = topology.triangles[at(f)];
    return grown(bounding_box(std::array{V[at(a)], V[at(b)], V[at(c)]}), half);
  });
  const PartTrees edges(topology.edge_parts, lattice, [&](std::int32_t e) {
    const auto& [a, b] = topology.edges[at(e)];
    return grown(bounding_box(std::array{V[at(a)], V[at(b)]}), half);
  });
  const auto record = [&](Tally& chunk, EventKind event, std::int32_t i, std::int32_t j, bool farther, auto&& compare) {
    if (farther) return;
    ++chunk.pairs.exact;
    if (compare() < 0) chunk.add({event, {i, j}, "near"});
  };
  vertices.tally_between(faces, options.check_bodies, options.max_violations, tally,
                         [&](std::int32_t v, std::int32_t f, Tally& chunk) {
                           const auto& [a, b, c] = topology.triangles[at(f)];
                           if (v == a || v == b || v == c) return;
                           if (chunk.is_exempt(topology, topology.vertex_labels, v, topology.face_labels, f)) return;
                           ++chunk.pairs.vf;
                           const std::array<Point, 4> x = {V[at(v)], V[at(a)], V[at(b)], V[at(c)]};
                           record(chunk, EventKind::kVf, v, f, triage_vf_farther(x, distance),
                                  [&] { return compare_vf_distance(x, distance); });
                         });
  edges.tally_within(options.check_bodies, options.max_violations, tally,
                     [&](std::int32_t e, std::int32_t f, Tally& chunk) {
                       if (f < e) std::swap(e, f);
                       const auto& [a, b] = topology.edges[at(e)];
                       const auto& [c, d] = topology.edges[at(f)];
                       if (a == c || a == d || b == c || b == d) return;
                       if (chunk.is_exempt(topology, topology.edge_labels, e, topology.edge_labels, f)) return;
                       ++chunk.pairs.ee;
                       const std::array<Point, 4> x = {V[at(a)], V[at(b)], V[at(c)], V[at(d)]};
                       record(chunk, EventKind::kEe, e, f, triage_ee_farther(x, distance),
                              [&] { return compare_ee_distance(x, distance); });
                     });
}

}  // namespace selvage::verify
