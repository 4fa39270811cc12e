#include "kernel/broad/fitted_boxes.h"

#include "kernel/fp_env.h"
#include "kernel/own_tasks.h"

namespace selvage {

namespace {

/// Items a task takes at least, so that it costs some 10 us: far more than it costs to start it.
constexpr std::size_t kGrainVertices = 512, kGrainClusters = 64, kGrainNodes = 64;

template <typename Body>
void parallel_range(std::size_t begin, std::size_t end, std::size_t grain, const Body& body) {
  own_parallel_for(tbb::blocked_range<std::size_t>(begin, end, grain), [&](const auto& range) {
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
    : vertex_active_(static_cast<std::size_t>(mesh.vertex_count)),
      cluster_active_(clusters.cluster_count()),
      node_active_(clusters.nodes.size()) {
  t0_.resize(vertex_active_.size(), cluster_active_.size());
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
  mark_active(mesh, clusters, options.active);
  // Whatever an exception leaves of these, what is read has its size.
  if (options.boxes == MotionBoxes::kMoving) t1_.resize(vertex_active_.size(), cluster_active_.size());
  for (BoxColumns* columns : {&faces_, &edges_, &children_}) columns->hold(options.boxes);
  if (options.boxes == MotionBoxes::kSwept) {
    fit(mesh, clusters, V_t0, V_t1, options.reach, t0_, &BoxColumns::t0);
  } else {
    fit(mesh, clusters, V_t0, V_t0, options.reach, t0_, &BoxColumns::t0);
    fit(mesh, clusters, V_t1, V_t1, options.reach, t1_, &BoxColumns::t1);
  }
}

void FittedBoxes::fit(const Mesh& mesh, const FaceClusters& clusters, const PositionsRef& V_a, const PositionsRef& V_b,
                      double reach, Boxes& boxes, End end) {
  parallel_range(0, boxes.vertices.size(), kGrainVertices,
                 [&](std::size_t v) { boxes.vertices[v] = vertex_box(V_a, V_b, static_cast<VertexId>(v), reach); });
  parallel_range(0, boxes.clusters.size(), kGrainClusters,
                 [&](std::size_t c) { boxes.clusters[c] = fit_cluster(mesh, clusters, c, boxes, end); });
  for (std::size_t level = clusters.level_begin.size(); level-- > 1;) {
    parallel_range(clusters.level_begin[level - 1], clusters.level_begin[level], kGrainNodes, [&](std::size_t n) {
      const FaceClusters::Node& node = clusters.nodes[n];
      for (std::size_t k = 0; k < node.child_count; ++k) {
        const TreeRef ref = node.child[k];
        const Box box = ref < 0 ? boxes.clusters[static_cast<std::size_t>(~ref)]
                                : node_box(clusters, static_cast<std::size_t>(ref), end);
        (children_.*end).set(FaceClusters::kFanOut * n + k, box);
      }
    });
  }
}

Box FittedBoxes::fit_cluster(const Mesh& mesh, const FaceClusters& clusters, std::size_t c, const Boxes& boxes,
                             End end) {
  const auto of_vertex = [&](VertexId v) -> const Box& { return boxes.vertices[static_cast<std::size_t>(v)]; };
  Box all;
  std::size_t row = clusters.faces.begin[c];
  for (const FaceId f : clusters.faces.of(c)) {
    const auto& corners = mesh.faces[static_cast<std::size_t>(f)];
    const Box box = united(united(of_vertex(corners[0]), of_vertex(corners[1])), of_vertex(corners[2]));
    (faces_.*end).set(row++, box);
    all.merge(box);
  }
  row = clusters.edges.begin[c];
  for (const EdgeId e : clusters.edges.of(c)) {
    const auto& ends = mesh.edges[static_cast<std::size_t>(e)];
    (edges_.*end).set(row++, united(of_vertex(ends[0]), of_vertex(ends[1])));
  }
  return all;
}

Box FittedBoxes::node_box(const FaceClusters& clusters, std::size_t n, End end) const {
  Box all;
  for (std::size_t k = 0; k < clusters.nodes[n].child_count; ++k)
    all.merge((children_.*end).row(FaceClusters::kFanOut * n + k));
  return all;
}

void FittedBoxes::mark_active(const Mesh& mesh, const FaceClusters& clusters, std::span<const std::uint8_t> active) {
  if (active.empty()) {
    for (auto* flags : {&vertex_active_, &cluster_active_, &node_active_}) std::ranges::fill(*flags, 1);
    return;
  }
  std::ranges::copy(active, vertex_active_.begin());
  parallel_range(0, cluster_active_.size(), kGrainClusters, [&](std::size_t c) {
    const auto holds_one = [&](FaceId f) { return is_active(mesh.faces[static_cast<std::size_t>(f)]); };
    cluster_active_[c] = std::ranges::any_of(clusters.faces.of(c), holds_one) ? 1 : 0;
  });
  for (std::size_t n = node_active_.size(); n-- > 0;) {  // parents stand before their children
    const FaceClusters::Node& node = clusters.nodes[n];
    const auto holds_one = [&](TreeRef ref) { return is_active(ref); };
    node_active_[n] = std::any_of(node.child.begin(), node.child.begin() + node.child_count, holds_one) ? 1 : 0;
  }
}

}  // namespace selvage
