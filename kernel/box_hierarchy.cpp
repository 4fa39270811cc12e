#include "kernel/box_hierarchy.h"

#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include <tbb/blocked_range.h>

#include "kernel/assert.h"
#include "kernel/box.h"
#include "kernel/broad/pair_finder.h"
#include "kernel/broad/spatial_face_tree.h"
#include "kernel/fp_env.h"
#include "kernel/own_tasks.h"

namespace selvage {

namespace {

/// The tree is chosen again when its boxes have this times the surface they had: queries then take about that much
/// longer (docs/measurements/broad-phase.md), while making and choosing costs a third of a query once.
constexpr double kGrowthMax = 1.5;

/// What a query will cost with these clusters, up to a factor: the sum of the surfaces of their boxes (the chance that
/// boxes of one size and any place meet; MacDonald and Booth 1990). Of the vertices they own alone, as they move from
/// V_t0 to V_t1: all vertices once. The sum has a fixed order (K7). Near kMaxCoordinate it overflows, near subnormal
/// coordinates it vanishes; either way a comparison is false and nothing is chosen again.
double surface(const FaceClusters& clusters, const PositionsRef& V_t0, const PositionsRef& V_t1) {
  constexpr std::size_t kGrainClusters = 256;  // some 20 us
  std::vector<double> surfaces(clusters.cluster_count());
  own_parallel_for(tbb::blocked_range<std::size_t>(0, surfaces.size(), kGrainClusters), [&](const auto& range) {
    const FpEnvGuard guard;
    for (std::size_t c = range.begin(); c != range.end(); ++c) {
      if (clusters.vertices.of(c).empty()) continue;
      Box box;
      for (const VertexId v : clusters.vertices.of(c)) box.merge(vertex_box(V_t0, V_t1, v, 0));
      const double x = box.upper[0] - box.lower[0], y = box.upper[1] - box.lower[1], z = box.upper[2] - box.lower[2];
      surfaces[c] = x * y + y * z + z * x;
    }
  });
  return std::accumulate(surfaces.begin(), surfaces.end(), 0.0);
}

}  // namespace

struct BoxHierarchy::Impl {
  Impl(const Mesh& own_mesh, HierarchyKind own_kind) : mesh(own_mesh), kind(own_kind) {
    if (kind != HierarchyKind::kSpatial) topology = make_face_clusters(mesh, make_face_tree(mesh));
  }
  /// Sees to it that there is a tree, and a good one, for the motion from V_t0 to V_t1.
  void choose(const PositionsRef& V_t0, const PositionsRef& V_t1) {
    if (chosen != nullptr) {
      if (kind == HierarchyKind::kTopology) return;
      // At V_t0: how far a motion goes says nothing about the tree.
      if (!(surface(*chosen, V_t0, V_t0) > kGrowthMax * surface_when_chosen)) return;
    }
    chosen = nullptr;  // until its boxes are there: an exception may end this
    boxes.reset();
    if (kind != HierarchyKind::kTopology) {
      spatial = make_face_clusters(mesh, make_spatial_face_tree(mesh, V_t0, V_t1));
    }
    const bool by_position =
        kind == HierarchyKind::kSpatial ||
        (kind == HierarchyKind::kAutomatic && surface(spatial, V_t0, V_t1) < surface(topology, V_t0, V_t1));
    const FaceClusters& better = by_position ? spatial : topology;
    surface_when_chosen = surface(better, V_t0, V_t0);
    boxes.emplace(mesh, better);
    chosen = &better;
  }

  const Mesh& mesh;
  HierarchyKind kind;
  FaceClusters topology, spatial;        ///< empty where not needed
  const FaceClusters* chosen = nullptr;  ///< one of them
  double surface_when_chosen = 0;
  std::optional<FittedBoxes> boxes;  ///< of the chosen one
};

BoxHierarchy::BoxHierarchy(const Mesh& mesh, HierarchyKind kind) : impl_(std::make_unique<Impl>(mesh, kind)) {}
BoxHierarchy::~BoxHierarchy() = default;
BoxHierarchy::BoxHierarchy(BoxHierarchy&&) noexcept = default;
BoxHierarchy& BoxHierarchy::operator=(BoxHierarchy&&) noexcept = default;

bool BoxHierarchy::fits(const Mesh& mesh) const {
  const Mesh& own = impl_->mesh;
  return mesh.vertex_count == own.vertex_count && mesh.edges.size() == own.edges.size() &&
         mesh.faces.size() == own.faces.size();
}

void BoxHierarchy::refit(const PositionsRef& V_t0, const PositionsRef& V_t1, const CandidateOptions& options) {
  const FpEnvGuard guard;
  SELVAGE_REQUIRE(V_t0.rows() == impl_->mesh.vertex_count && V_t1.rows() == impl_->mesh.vertex_count);
  SELVAGE_REQUIRE(options.active.empty() || std::ssize(options.active) == impl_->mesh.vertex_count);
  SELVAGE_REQUIRE(options.reach >= 0 && std::isfinite(options.reach));
  impl_->choose(V_t0, V_t1);
  impl_->boxes->refit(impl_->mesh, *impl_->chosen, V_t0, V_t1, options);
}

Candidates BoxHierarchy::candidates() const { return *candidates(std::numeric_limits<std::size_t>::max()); }

std::optional<Candidates> BoxHierarchy::candidates(std::size_t most) const {
  const FpEnvGuard guard;
  SELVAGE_REQUIRE(impl_->boxes);
  return find_pairs(impl_->mesh, *impl_->chosen, *impl_->boxes, most);
}

void BoxHierarchy::visit_candidates(const CandidateVisitor& visit) const {
  const FpEnvGuard guard;
  SELVAGE_REQUIRE(impl_->boxes);
  visit_pairs(impl_->mesh, *impl_->chosen, *impl_->boxes, visit);
}

}  // namespace selvage
