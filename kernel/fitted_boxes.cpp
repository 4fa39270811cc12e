#include "kernel/fitted_boxes.h"

#include <tbb/parallel_for.h>

#include "kernel/assert.h"
#include "kernel/fp_env.h"

namespace selvage {

namespace {

/// Items a task takes at least, so that it costs some 10 us: far more than it costs to start it.
constexpr std::size_t kGrainVertices = 512, kGrainClusters = 64, kGrainNodes = 64;

template <typename Body>
void parallel_range(std::size_t begin, std::size_t end, std::size_t grain, const Body& body) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(begin, end, grain), [&](const auto& range) {
    const FpEnvGuard guard;
    for (std::size_t i = range.begin(); i != range.end(); ++i) body(i);
  });
}

template <typename Id>
void set_keys(const std::vector<Id>& items, BoxColumns& boxes) {
  boxes.resize(items.size());
  for (std::size_t row = 0; row < items.size(); ++row) {
    boxes.key[row] = static_cast<std::uint64_t>(items[row]) << 32 | row;
  }
}

}  // namespace

FittedBoxes::FittedBoxes(const Mesh& mesh, const FaceClusters& clusters)
    : vertices_(static_cast<std::size_t>(mesh.vertex_count)),
      clusters_(clusters.cluster_count()),
      cluster_active_(clusters.cluster_count()),
      node_active_(clusters.nodes.size()) {
  set_keys(clusters.faces.items, faces_);
  set_keys(clusters.edges.items, edges_);
  children_.resize(FaceClusters::kFanOut * clusters.nodes.size());
  for (std::size_t row = 0; row < children_.row_count(); ++row) {
    const TreeRef ref = clusters.nodes[row / FaceClusters::kFanOut].child[row % FaceClusters::kFanOut];
    children_.key[row] = static_cast<std::uint32_t>(ref);
  }
}

void FittedBoxes::refit(const Mesh& mesh, const FaceClusters& clusters, const PositionsRef& V_t0,
                        const PositionsRef& V_t1, const CandidateOptions& options) {
  SELVAGE_ASSERT(V_t0.rows() == mesh.vertex_count && V_t1.rows() == mesh.vertex_count);
  SELVAGE_ASSERT(options.active.empty() || options.active.size() == vertices_.size());
  SELVAGE_ASSERT(options.reach >= 0);
  vertex_active_.assign(vertices_.size(), 1);
  std::copy(options.active.begin(), options.active.end(), vertex_active_.begin());
  parallel_range(0, vertices_.size(), kGrainVertices, [&](std::size_t v) {
    vertices_[v] = vertex_box(V_t0, V_t1, static_cast<VertexId>(v), options.reach);
  });
  parallel_range(0, clusters_.size(), kGrainClusters,
                 [&](std::size_t c) { clusters_[c] = fit_cluster(mesh, clusters, c); });
  for (std::size_t level = clusters.level_begin.size(); level-- > 1;) {
    parallel_range(clusters.level_begin[level - 1], clusters.level_begin[level], kGrainNodes,
                   [&](std::size_t n) { fit_node(clusters, n); });
  }
}

Box FittedBoxes::fit_cluster(const Mesh& mesh, const FaceClusters& clusters, std::size_t c) {
  Box all;
  bool active = false;
  std::size_t row = clusters.faces.begin[c];
  for (const FaceId f : clusters.faces.of(c)) {
    const auto& corners = mesh.faces[static_cast<std::size_t>(f)];
    const Box box = united(united(vertex(corners[0]), vertex(corners[1])), vertex(corners[2]));
    faces_.set(row++, box);
    all.merge(box);
    active = active || is_active(corners);
  }
  cluster_active_[c] = active ? 1 : 0;
  row = clusters.edges.begin[c];
  for (const EdgeId e : clusters.edges.of(c)) {
    const auto& ends = mesh.edges[static_cast<std::size_t>(e)];
    edges_.set(row++, united(vertex(ends[0]), vertex(ends[1])));
  }
  return all;
}

Box FittedBoxes::node_box(const FaceClusters& clusters, std::size_t n) const {
  Box all;
  for (std::size_t k = 0; k < clusters.nodes[n].child_count; ++k)
    all.merge(children_.row(FaceClusters::kFanOut * n + k));
  return all;
}

void FittedBoxes::fit_node(const FaceClusters& clusters, std::size_t n) {
  const FaceClusters::Node& node = clusters.nodes[n];
  bool active = false;
  for (std::size_t k = 0; k < node.child_count; ++k) {
    const TreeRef ref = node.child[k];
    children_.set(FaceClusters::kFanOut * n + k, ref < 0 ? clusters_[static_cast<std::size_t>(~ref)]
                                                         : node_box(clusters, static_cast<std::size_t>(ref)));
    active = active || is_active(ref);
  }
  node_active_[n] = active ? 1 : 0;
}

}  // namespace selvage
