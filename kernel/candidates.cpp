#include "kernel/candidates.h"

#include <algorithm>

#include "kernel/assert.h"

namespace selvage {

std::array<VertexId, 4> pair_vertices(const Mesh& mesh, PairKind kind, std::int32_t first, std::int32_t second) {
  if (kind == PairKind::kEe) return pair_vertices(mesh, EeCandidate{first, second});
  if (kind == PairKind::kVf) return pair_vertices(mesh, VfCandidate{first, second});
  const auto& corners = mesh.faces[static_cast<std::size_t>(second)];
  const auto own = static_cast<std::size_t>(std::find(corners.begin(), corners.end(), first) - corners.begin());
  SELVAGE_ASSERT(own < 3);
  return {first, corners[(own + 1) % 3], corners[(own + 2) % 3], first};
}

}  // namespace selvage
