// The face tree laid out for traversal: its lowest subtrees become clusters of a few faces, the rest becomes nodes of
// up to eight children.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "kernel/broad/face_tree.h"

namespace selvage {

/// A child is a node (>= 0) or the cluster ~child.
using TreeRef = std::int32_t;

/// Items of all clusters, one cluster after another.
template <typename Id>
struct PerCluster {
  std::vector<std::size_t> begin{0};
  std::vector<Id> items;

  [[nodiscard]] std::span<const Id> of(std::size_t cluster) const {
    return std::span(items).subspan(begin[cluster], begin[cluster + 1] - begin[cluster]);
  }
};

struct FaceClusters {
  static constexpr std::size_t kFanOut = 8;  ///< as many doubles as the widest vector unit compares at once
  struct Node {
    std::array<TreeRef, kFanOut> child;
    std::size_t child_count;
  };
  std::vector<Node> nodes;               ///< nodes[0] is the root; children come after their parents
  std::vector<std::size_t> level_begin;  ///< nodes of equal depth are contiguous: a refit runs level by level
  /// Clusters in depth-first order: neighbours in memory are neighbours on the surface.
  PerCluster<FaceId> faces;
  PerCluster<EdgeId> edges;       ///< those the cluster's faces own, ascending
  PerCluster<VertexId> vertices;  ///< those the cluster's faces own, ascending

  [[nodiscard]] std::size_t cluster_count() const { return faces.begin.size() - 1; }
};

/// O(#F). `tree` is over the faces of `mesh`; a mesh without faces has no nodes and no clusters.
[[nodiscard]] FaceClusters make_face_clusters(const Mesh& mesh, const FaceTree& tree);

}  // namespace selvage
