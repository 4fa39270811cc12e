#include <cmath>

#include "kernel/assert.h"
#include "kernel/box.h"
#include "kernel/candidates.h"
#include "kernel/fp_env.h"

namespace selvage {

namespace {

struct Feature {
  MovingBox box;
  bool active = false;
};

/// The union over the feature's vertices.
template <std::size_t N>
Feature unite(const std::vector<Feature>& of_vertex, const std::array<VertexId, N>& vertices) {
  Feature feature;
  for (const VertexId v : vertices) {
    const Feature& part = of_vertex[static_cast<std::size_t>(v)];
    feature.box.merge(part.box);
    feature.active = feature.active || part.active;
  }
  return feature;
}

bool is_candidate(const Feature& a, const Feature& b) { return (a.active || b.active) && overlap(a.box, b.box); }

template <std::size_t N, std::size_t M>
bool share_vertex(const std::array<VertexId, N>& a, const std::array<VertexId, M>& b) {
  return std::any_of(a.begin(), a.end(), [&](VertexId v) { return std::find(b.begin(), b.end(), v) != b.end(); });
}

}  // namespace

Candidates find_candidates_brute_force(const Mesh& mesh, const PositionsRef& V_t0, const PositionsRef& V_t1,
                                       const CandidateOptions& options) {
  const FpEnvGuard guard;
  const auto vertex_count = static_cast<std::size_t>(mesh.vertex_count);
  SELVAGE_REQUIRE(V_t0.rows() == mesh.vertex_count && V_t1.rows() == mesh.vertex_count);
  SELVAGE_REQUIRE(options.active.empty() || options.active.size() == vertex_count);
  SELVAGE_REQUIRE(options.reach >= 0 && std::isfinite(options.reach));

  std::vector<Feature> of_vertex(vertex_count), of_edge, of_face;
  for (std::size_t v = 0; v < vertex_count; ++v) {
    of_vertex[v] = {vertex_box(V_t0, V_t1, static_cast<VertexId>(v), options.reach, options.boxes),
                    options.active.empty() || options.active[v] != 0};
  }
  for (const auto& edge : mesh.edges) of_edge.push_back(unite(of_vertex, edge));
  for (const auto& face : mesh.faces) of_face.push_back(unite(of_vertex, face));

  Candidates found;
  for (std::size_t v = 0; v < vertex_count; ++v) {
    if (mesh.vertex_owner[v] < 0) continue;
    const std::array<VertexId, 1> vertex = {static_cast<VertexId>(v)};
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
      if (is_candidate(of_vertex[v], of_face[f]) && !share_vertex(vertex, mesh.faces[f])) {
        found.vf.push_back({vertex[0], static_cast<FaceId>(f)});
      }
    }
  }
  for (std::size_t a = 0; a < mesh.edges.size(); ++a) {
    for (std::size_t b = a + 1; b < mesh.edges.size(); ++b) {
      if (is_candidate(of_edge[a], of_edge[b]) && !share_vertex(mesh.edges[a], mesh.edges[b])) {
        found.ee.push_back({static_cast<EdgeId>(a), static_cast<EdgeId>(b)});
      }
    }
  }
  return found;
}

}  // namespace selvage
