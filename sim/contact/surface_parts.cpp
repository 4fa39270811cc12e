#include "sim/contact/surface_parts.h"

#include "sim/base/disjoint_sets.h"

namespace selvage::sim {

SurfaceParts::SurfaceParts(const Mesh& mesh) : part_(static_cast<std::size_t>(mesh.vertex_count)) {
  DisjointSets<VertexId> sets(mesh.vertex_count);
  for (const auto& edge : mesh.edges) sets.join(edge[0], edge[1]);
  for (VertexId v = 0; v < mesh.vertex_count; ++v) part_[static_cast<std::size_t>(v)] = sets.root(v);
}

std::vector<std::uint8_t> SurfaceParts::cloth_flags(const CollisionBodies& bodies) const {
  std::vector<std::uint8_t> part_is_cloth(part_.size(), 0);
  for (std::size_t v = 0; v < part_.size(); ++v) {
    const bool on_body = !bodies.body.empty() && bodies.body[v] >= 0 && bodies.body[v] < bodies.first_pin;
    if (bodies.inverse_mass[v] > 0 || !on_body) part_is_cloth[static_cast<std::size_t>(part_[v])] = 1;
  }
  std::vector<std::uint8_t> flags(part_.size());
  for (std::size_t v = 0; v < part_.size(); ++v) flags[v] = part_is_cloth[static_cast<std::size_t>(part_[v])];
  return flags;
}

}  // namespace selvage::sim
