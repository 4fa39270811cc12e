#include "kernel/box_hierarchy.h"

#include <numeric>
#include <optional>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "kernel/assert.h"
#include "kernel/box.h"
#include "kernel/fp_env.h"
#include "kernel/pair_finder.h"
#include "kernel/spatial_face_tree.h"

namespace selvage {

namespace {

/// A tree by position is made anew when the clusters are this much larger than when it was made. Measured on a sheet
/// that is sheared and crumpled: docs/broad-phase.md.
constexpr double kSpreadMax = 1.25;

/// How far the clusters reach: the sum over them of the extents of their own vertices at one instant. Neither the
/// motion nor `reach` counts, which come and go between refits. Each sum is made in a fixed order (K7). An overflow to
/// infinity, near kMaxCoordinate, is harmless: no tree is made anew.
double spread(const FaceClusters& clusters, const PositionsRef& V) {
  std::vector<double> extents(clusters.cluster_count());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, extents.size(), 256), [&](const auto& range) {
    const FpEnvGuard guard;
    for (std::size_t c = range.begin(); c != range.end(); ++c) {
      Box box;
      for (const VertexId v : clusters.vertices.of(c)) box.merge(vertex_box(V, V, v, 0));
      for (std::size_t axis = 0; axis < 3; ++axis) {
        if (box.lower[axis] <= box.upper[axis]) extents[c] += box.upper[axis] - box.lower[axis];
      }
    }
  });
  return std::accumulate(extents.begin(), extents.end(), 0.0);
}

}  // namespace

struct BoxHierarchy::Impl {
  Impl(const Mesh& own_mesh, HierarchyKind own_kind) : mesh(own_mesh), kind(own_kind) {
    if (kind == HierarchyKind::kTopology) set_tree(make_face_tree(mesh));
  }
  void set_tree(const FaceTree& tree) {
    clusters = make_face_clusters(mesh, tree);
    boxes.emplace(mesh, clusters);
  }
  void follow(const PositionsRef& V_t0, const PositionsRef& V_t1) {
    if (boxes && !(spread(clusters, V_t0) > kSpreadMax * spread_when_made)) return;
    set_tree(make_spatial_face_tree(mesh, V_t0, V_t1));
    spread_when_made = spread(clusters, V_t0);
  }

  const Mesh& mesh;
  HierarchyKind kind;
  FaceClusters clusters;
  std::optional<FittedBoxes> boxes;  ///< none before a tree by position is made
  double spread_when_made = 0;
  bool fitted = false;
};

BoxHierarchy::BoxHierarchy(const Mesh& mesh, HierarchyKind kind) : impl_(std::make_unique<Impl>(mesh, kind)) {}
BoxHierarchy::~BoxHierarchy() = default;
BoxHierarchy::BoxHierarchy(BoxHierarchy&&) noexcept = default;
BoxHierarchy& BoxHierarchy::operator=(BoxHierarchy&&) noexcept = default;

void BoxHierarchy::refit(const PositionsRef& V_t0, const PositionsRef& V_t1, const CandidateOptions& options) {
  const FpEnvGuard guard;
  SELVAGE_ASSERT(V_t0.rows() == impl_->mesh.vertex_count && V_t1.rows() == impl_->mesh.vertex_count);
  if (impl_->kind == HierarchyKind::kSpatial) impl_->follow(V_t0, V_t1);
  impl_->boxes->refit(impl_->mesh, impl_->clusters, V_t0, V_t1, options);
  impl_->fitted = true;
}

Candidates BoxHierarchy::candidates() const {
  const FpEnvGuard guard;
  SELVAGE_ASSERT(impl_->fitted);
  return find_pairs(impl_->mesh, impl_->clusters, *impl_->boxes);
}

}  // namespace selvage
