#include "sim/base/vertex_faces.h"

#include <numeric>

namespace selvage::sim {

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
