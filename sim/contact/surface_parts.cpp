#include "sim/contact/surface_parts.h"

#include "sim/base/disjoint_sets.h"

namespace selvage::sim {

SurfaceParts::SurfaceParts(const Mesh& mesh) : part_(static_cast<std::size_t>(mesh.vertex_count)) {
  DisjointSets<VertexId> sets(mesh.vertex_count);
  for (const auto& edge : mesh.edges) sets.join(edge[0], edge[1]);
  for (VertexId v = 0; v < mesh.vertex_count; ++v) part_[static_cast<std::size_t>(v)] = sets.root(v);
}

std::vector<std::uint8_t> SurfaceParts::cloth_flags(const CollisionBodies& bodies) const {
  std::vector<std::uint8_t> is_cloth(part_.size(), 0);
  for (std::size_t v = 0; v < part_.size(); ++v) {
    const bool on_body = !bodies.body.empty() && bodies.body[v] >= 0 && bodies.body[v] < bodies.first_pin;
    is_cloth[v] = bodies.inverse_mass[v] > 0 || !on_body;
  }
  return spread(is_cloth);
}

std::vector<std::uint8_t> SurfaceParts::spread(const std::vector<std::uint8_t>& flags) const {
  std::vector<std::uint8_t> of_part(part_.size(), 0), spread(part_.size());
  for (std::size_t v = 0; v < part_.size(); ++v) of_part[static_cast<std::size_t>(part_[v])] |= flags[v];
  for (std::size_t v = 0; v < part_.size(); ++v) spread[v] = of_part[static_cast<std::size_t>(part_[v])];
  return spread;
}

}  // namespace selvage::sim
