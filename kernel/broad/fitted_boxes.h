// The boxes of every feature and tree node for one motion: what the hierarchy refits.
#pragma once

#include <algorithm>

#include "kernel/broad/box_columns.h"
#include "kernel/broad/face_clusters.h"
#include "kernel/candidates.h"

namespace selvage {

/// Every box holds those below it: a face's is the union of its vertices', a cluster's of its faces', a node's of its
/// children's; and a feature's box lies in its owner's, whose vertices include its own.
class FittedBoxes {
 public:
  FittedBoxes(const Mesh& mesh, const FaceClusters& clusters);

  /// O(#V + #F), in parallel.
  void refit(const Mesh& mesh, const FaceClusters& clusters, const PositionsRef& V_t0, const PositionsRef& V_t1,
             const CandidateOptions& options);

  [[nodiscard]] MovingBox vertex(VertexId v) const {
    return {t0_.vertices[static_cast<std::size_t>(v)], (is_moving() ? t1_ : t0_).vertices[static_cast<std::size_t>(v)]};
  }
  /// Whether the cluster's box overlaps `box`, of the same kind.
  [[nodiscard]] bool overlaps(TreeRef ref, const MovingBox& box) const {
    const Box& first = t0_.clusters[static_cast<std::size_t>(~ref)];
    if (!is_moving()) return overlap(first, box.t0);  // half as many comparisons, and no copy of what holds both
    return overlap(MovingBox{first, t1_.clusters[static_cast<std::size_t>(~ref)]}, box);
  }
  /// Rows as in FaceClusters::faces and ::edges; the key is feature * 2^32 + row.
  [[nodiscard]] const BoxColumns& faces() const { return faces_; }
  [[nodiscard]] const BoxColumns& edges() const { return edges_; }
  /// Row kFanOut * n + k is child k of node n; the key is its TreeRef as 32 bits.
  [[nodiscard]] const BoxColumns& children() const { return children_; }

  template <std::size_t N>
  [[nodiscard]] bool is_active(const std::array<VertexId, N>& vertices) const {
    return std::any_of(vertices.begin(), vertices.end(),
                       [this](VertexId v) { return vertex_active_[static_cast<std::size_t>(v)] != 0; });
  }
  /// Whether a vertex of a face below is active.
  [[nodiscard]] bool is_active(TreeRef ref) const {
    return (ref < 0 ? cluster_active_[static_cast<std::size_t>(~ref)] : node_active_[static_cast<std::size_t>(ref)]) !=
           0;
  }

 private:
  /// The boxes of one end; swept ones are in t0_ alone.
  struct Boxes {
    std::vector<Box> vertices, clusters;
    void resize(std::size_t vertex_count, std::size_t cluster_count) {
      vertices.resize(vertex_count);
      clusters.resize(cluster_count);
    }
  };
  using End = BoxColumns::Bounds BoxColumns::*;

  [[nodiscard]] bool is_moving() const { return faces_.boxes() == MotionBoxes::kMoving; }
  /// All boxes of one end, of the motion from V_a to V_b.
  void fit(const Mesh& mesh, const FaceClusters& clusters, const PositionsRef& V_a, const PositionsRef& V_b,
           double reach, Boxes& boxes, End end);
  /// Fits the cluster's features and returns the box of the cluster.
  Box fit_cluster(const Mesh& mesh, const FaceClusters& clusters, std::size_t c, const Boxes& boxes, End end);
  [[nodiscard]] Box node_box(const FaceClusters& clusters, std::size_t n, End end) const;
  void mark_active(const Mesh& mesh, const FaceClusters& clusters, std::span<const std::uint8_t> active);

  Boxes t0_, t1_;
  BoxColumns faces_, edges_, children_;
  std::vector<std::uint8_t> vertex_active_, cluster_active_, node_active_;
};

}  // namespace selvage
