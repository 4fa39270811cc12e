#include "sim/base/vertex_faces.h"

#include <algorithm>
#include <numeric>

namespace selvage::sim {

std::optional<VertexId> corner_across(const std::array<VertexId, 3>& face, VertexId a, VertexId b) {
  const auto is_end = [&](VertexId v) { return v == a || v == b; };
  if (std::ranges::count_if(face, is_end) != 2) return std::nullopt;
  return *std::ranges::find_if_not(face, is_end);
}

VertexFaces::VertexFaces(const Mesh& mesh) : begin_(static_cast<std::size_t>(mesh.vertex_count) + 1) {
  for (const auto& face : mesh.faces) {
    for (const VertexId corner : face) ++begin_[static_cast<std::size_t>(corner) + 1];
  }
  std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
  faces_.resize(3 * mesh.faces.size());
  std::vector<std::size_t> next(begin_.begin(), begin_.end() - 1);
  for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
    for (const VertexId corner : mesh.faces[face]) {
      faces_[next[static_cast<std::size_t>(corner)]++] = static_cast<FaceId>(face);
    }
  }
}

}  // namespace selvage::sim
