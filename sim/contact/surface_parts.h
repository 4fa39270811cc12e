// The connected parts of the surface: a part without cloth is a scripted body, and two features of bodies are not
// tested against each other. A pinned vertex of the cloth is cloth, whichever body its pin moves with.
#pragma once

#include <cstdint>
#include <vector>

#include "kernel/mesh.h"
#include "sim/contact/collision_bodies.h"

namespace selvage::sim {

class SurfaceParts {
 public:
  /// O(#E), once for a mesh.
  explicit SurfaceParts(const Mesh& mesh);
  /// The smallest vertex of the vertex' part.
  [[nodiscard]] VertexId part(VertexId vertex) const { return part_[static_cast<std::size_t>(vertex)]; }
  /// #V: 1 where the vertex' part holds a vertex with mass, or one without a body, or with a pin. O(#V).
  [[nodiscard]] std::vector<std::uint8_t> cloth_flags(const CollisionBodies& bodies) const;
  /// #V: 1 where some vertex of the vertex' part has a flag; flags: #V. O(#V).
  [[nodiscard]] std::vector<std::uint8_t> spread(const std::vector<std::uint8_t>& flags) const;

 private:
  std::vector<VertexId> part_;  ///< #V: the smallest vertex of the part
};

}  // namespace selvage::sim
