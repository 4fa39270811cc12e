// Finds the candidate pairs of a fitted hierarchy.
#pragma once

#include <cstddef>
#include <optional>

#include "kernel/broad/fitted_boxes.h"
#include "kernel/candidates.h"

namespace selvage {

/// Equal to find_candidates_brute_force (K6), for any number of threads (K7). Nothing is lost: let the boxes of two
/// features overlap. The box of a feature lies in that of its owner, that in the box of the owner's cluster, and that
/// in the box of every node above (FittedBoxes): so the boxes of the two clusters overlap, and those of all pairs of
/// nodes above them, and the descent, which follows every overlapping pair, reaches the pair of clusters. There every
/// owned feature of the one is tested against every feature of the other. Nothing is found twice, because a feature
/// lies in one cluster only: that of its owner. Likewise an active vertex of a feature is a corner of its owner, so a
/// subtree marked inactive holds no active feature.
/// Nothing where there are more than `most`, which costs memory for about so many.
[[nodiscard]] std::optional<Candidates> find_pairs(const Mesh& mesh, const FaceClusters& clusters,
                                                   const FittedBoxes& boxes, std::size_t most);

/// The same pairs, given to `visit` as they are found (BoxHierarchy::visit_candidates).
void visit_pairs(const Mesh& mesh, const FaceClusters& clusters, const FittedBoxes& boxes,
                 const CandidateVisitor& visit);

}  // namespace selvage
