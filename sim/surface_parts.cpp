#include "sim/surface_parts.h"

#include <algorithm>
#include <numeric>

namespace selvage::sim {

SurfaceParts::SurfaceParts(const Mesh& mesh) : part_(static_cast<std::size_t>(mesh.vertex_count)) {
  std::iota(part_.begin(), part_.end(), 0);
  const auto parent = [this](VertexId v) -> VertexId& { return part_[static_cast<std::size_t>(v)]; };
  const auto root = [&](VertexId v) {
    while (parent(v) != v) v = parent(v) = parent(parent(v));  // halves the path, so that trees stay flat
    return v;
  };
  for (const auto& edge : mesh.edges) {
    const VertexId a = root(edge[0]), b = root(edge[1]);
    parent(std::max(a, b)) = std::min(a, b);
  }
  for (VertexId& part : part_) part = root(part);
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
