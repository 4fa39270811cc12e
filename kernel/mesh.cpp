#include "kernel/mesh.h"

#include <algorithm>
#include <cmath>

#include "kernel/assert.h"

namespace selvage {

namespace {

/// One side of a face on its way to becoming an edge. `side` is 3 * face + corner: an EdgeId must be able to count it.
struct Side {
  VertexId larger, smaller;
  std::int32_t side;
};

std::vector<Side> sorted_sides(const std::vector<std::array<VertexId, 3>>& faces) {
  std::vector<Side> sides;
  sides.reserve(3 * faces.size());
  for (std::size_t f = 0; f < faces.size(); ++f) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [smaller, larger] = std::minmax(faces[f][(k + 1) % 3], faces[f][(k + 2) % 3]);
      sides.push_back({larger, smaller, static_cast<std::int32_t>(3 * f + k)});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    if (a.larger != b.larger) return a.larger < b.larger;
    if (a.smaller != b.smaller) return a.smaller < b.smaller;
    return a.side < b.side;  // the lowest-numbered face comes first and becomes the owner
  });
  return sides;
}

InputError validate_positions(const Mesh& mesh, const PositionsRef& V) {
  if (V.rows() != mesh.vertex_count) return InputError::kSizeMismatch;
  for (Eigen::Index v = 0; v < V.rows(); ++v) {
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      if (!std::isfinite(V(v, axis))) return InputError::kNotFinite;
      if (std::abs(V(v, axis)) > kMaxCoordinate) return InputError::kTooLarge;
    }
  }
  return InputError::kNone;
}

}  // namespace

InputError validate_faces(std::int32_t vertex_count, const FacesRef& F) {
  if (vertex_count < 0) return InputError::kIndexOutOfRange;
  if (F.rows() > kMaxFaceCount) return InputError::kTooManyFaces;
  for (Eigen::Index f = 0; f < F.rows(); ++f) {
    for (Eigen::Index k = 0; k < 3; ++k) {
      if (F(f, k) < 0 || F(f, k) >= vertex_count) return InputError::kIndexOutOfRange;
    }
    if (F(f, 0) == F(f, 1) || F(f, 1) == F(f, 2) || F(f, 2) == F(f, 0)) return InputError::kRepeatedVertex;
  }
  return InputError::kNone;
}

Mesh make_mesh(std::int32_t vertex_count, const FacesRef& F) {
  SELVAGE_REQUIRE(validate_faces(vertex_count, F) == InputError::kNone);
  Mesh mesh;
  mesh.vertex_count = vertex_count;
  const auto face_count = static_cast<std::size_t>(F.rows());
  mesh.faces.resize(face_count);
  mesh.face_edges.resize(face_count);
  mesh.vertex_owner.assign(static_cast<std::size_t>(vertex_count), -1);
  for (std::size_t f = 0; f < face_count; ++f) {
    for (std::size_t k = 0; k < 3; ++k) {
      const VertexId v = F(static_cast<Eigen::Index>(f), static_cast<Eigen::Index>(k));
      mesh.faces[f][k] = v;
      FaceId& owner = mesh.vertex_owner[static_cast<std::size_t>(v)];
      if (owner < 0) owner = static_cast<FaceId>(f);
    }
  }
  for (const Side& side : sorted_sides(mesh.faces)) {
    const std::array<VertexId, 2> edge = {side.smaller, side.larger};
    if (mesh.edges.empty() || mesh.edges.back() != edge) {
      mesh.edges.push_back(edge);
      mesh.edge_owner.push_back(side.side / 3);
    }
    const auto slot = static_cast<std::size_t>(side.side);
    mesh.face_edges[slot / 3][slot % 3] = static_cast<EdgeId>(mesh.edges.size() - 1);
  }
  return mesh;
}

Mesh make_mesh(std::int32_t vertex_count, std::span<const std::array<VertexId, 3>> faces) {
  const VertexId* first = faces.empty() ? nullptr : faces.front().data();
  return make_mesh(vertex_count, Eigen::Map<const Faces>(first, std::ssize(faces), 3));
}

InputError validate(const Mesh& mesh, const PositionsRef& V_t0, const PositionsRef& V_t1) {
  const InputError error = validate_positions(mesh, V_t0);
  return error != InputError::kNone ? error : validate_positions(mesh, V_t1);
}

}  // namespace selvage
