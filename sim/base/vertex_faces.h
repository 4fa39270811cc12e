// The faces around each vertex: where the surface goes on beside a face.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "kernel/mesh.h"

namespace selvage::sim {

/// The corner of a face across from an edge, if that is one of its edges.
[[nodiscard]] std::optional<VertexId> corner_across(const std::array<VertexId, 3>& face, VertexId a, VertexId b);

class VertexFaces {
 public:
  /// O(#V + #F), 4 bytes for each corner and 8 for each vertex.
  explicit VertexFaces(const Mesh& mesh);

  /// Ascending.
  [[nodiscard]] std::span<const FaceId> of(VertexId vertex) const {
    const auto at = static_cast<std::size_t>(vertex);
    return std::span(faces_).subspan(begin_[at], begin_[at + 1] - begin_[at]);
  }
  /// Those of the end of an edge that has fewer, among which are the edge's own; ascending.
  [[nodiscard]] std::span<const FaceId> of_either(VertexId a, VertexId b) const {
    return of(a).size() < of(b).size() ? of(a) : of(b);
  }

 private:
  std::vector<std::size_t> begin_;  ///< of each vertex's; one more at the end
  std::vector<FaceId> faces_;
};

}  // namespace selvage::sim
