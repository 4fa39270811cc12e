// The geometric shrinker of meshes: a handful of vertices with short numbers instead of a surface.
#pragma once

#include "fuzz/kept/mesh_case.h"

namespace selvage::fuzz {

/// Tries, until nothing more is accepted or after `max_trials`: drop faces, many or one, with the vertices that no face
/// holds any more; set settings and marks to their simplest; keep a vertex, or all, where they are at another instant;
/// move a vertex to the origin, with all others; scale by a power of two; zero a coordinate, copy it from another
/// instant, round it to few bits. Accepts what is simpler and fails with the same word. Deterministic.
[[nodiscard]] MeshCase shrink(const MeshCase& kept, const std::string& failure, std::int64_t max_trials = 3000);

/// What shrinking makes smaller, first things first.
struct MeshCost {
  std::size_t faces = 0, vertices = 0;
  int numbers = 0;  ///< settings and marks that are not the simplest
  int non_zero = 0, moving = 0, bits = 0, exponents = 0;
  friend auto operator<=>(const MeshCost&, const MeshCost&) = default;
};
[[nodiscard]] MeshCost cost_of(const MeshCase& kept);

}  // namespace selvage::fuzz
