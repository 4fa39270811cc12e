// The paper's tree over the faces (section 6): adjacent nodes are paired greedily in sweeps of alternating direction,
// from connectivity alone, until one root is left.
#pragma once

#include <array>
#include <vector>

#include "kernel/mesh.h"

namespace selvage {

/// Nodes 0 .. #F-1 are the faces; node #F + i has the children children[i]; the last node is the root.
struct FaceTree {
  std::vector<std::array<std::int32_t, 2>> children;
};

/// Greedy: a node takes the free neighbour it shares most edges with, then the smallest, then the lowest-numbered.
/// Where that leaves more than half of a sweep's nodes free (fans and stars), free nodes with a common neighbour are
/// paired too; nodes without neighbours (whole components) are paired in order. So every sweep leaves at most 3/4 of
/// its nodes plus one, the depth is O(log #F), and the whole is O(#F). Faces that share an edge count as adjacent;
/// around an edge of many faces only consecutive ones do, which keeps the links linear in #F.
[[nodiscard]] FaceTree make_face_tree(const Mesh& mesh);

}  // namespace selvage
