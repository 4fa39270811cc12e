// A tree over the faces from where they are: halved across the longest extent of their centres, again and again.
#pragma once

#include "kernel/broad/face_tree.h"

namespace selvage {

/// Subtrees of at most this many faces are halved without looking at positions, and all but one are full: the traversal
/// takes such a subtree as a whole (face_clusters.h).
inline constexpr std::size_t kSpatialLeafFaces = 16;

/// Of the motion from V_t0 to V_t1 (pass one twice for an instant). The depth is at most log2 #F + 2, for any input.
/// O(#F log #F), in parallel; the same tree for any number of threads. The caller holds an FpEnvGuard.
/// Splitting by surface area (16 bins along three axes) instead made queries 3 to 6 % faster and took 40 % longer to
/// build; its depth has no such bound.
[[nodiscard]] FaceTree make_spatial_face_tree(const Mesh& mesh, const PositionsRef& V_t0, const PositionsRef& V_t1);

}  // namespace selvage
