// What hangs together of the cloth: by faces, and by the contacts that are told; not through bodies.
#pragma once

#include <span>

#include "sim/base/disjoint_sets.h"
#include "sim/contact/surface_parts.h"

namespace selvage::sim {

class ClothSets {
 public:
  /// By faces alone. The first `cloth_count` vertices are cloth. `parts` outlive it.
  ClothSets(const SurfaceParts& parts, VertexId cloth_count)
      : parts_(parts), cloth_count_(cloth_count), sets_(cloth_count) {}

  /// The cloth of a contact, by its vertices.
  void join(std::span<const VertexId> vertices) {
    VertexId one = -1;
    for (const VertexId v : vertices) {
      if (!is_cloth(v)) continue;
      if (one >= 0) sets_.join(parts_.part(one), parts_.part(v));
      one = v;
    }
  }
  [[nodiscard]] bool is_cloth(VertexId vertex) const { return vertex < cloth_count_; }
  /// That of a vertex of cloth: the smallest vertex in it, whatever the order of the joins.
  [[nodiscard]] std::size_t set(VertexId vertex) { return static_cast<std::size_t>(sets_.root(parts_.part(vertex))); }

 private:
  const SurfaceParts& parts_;
  VertexId cloth_count_;
  DisjointSets<VertexId> sets_;
};

}  // namespace selvage::sim
