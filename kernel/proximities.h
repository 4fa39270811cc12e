// Proximities of a whole mesh: broad phase, then the queries, in parallel, in a fixed order (K7).
#pragma once

#include <array>
#include <span>
#include <vector>

#include "kernel/box_hierarchy.h"
#include "kernel/proximity.h"

namespace selvage {

/// A pair that is near at one instant.
struct PairProximity {
  PairKind kind;                     ///< kVf or kEe
  std::int32_t first;                ///< vertex | edge
  std::int32_t second;               ///< face | edge
  std::array<VertexId, 4> vertices;  ///< in the order of vf_proximity / ee_proximity
  Proximity proximity;               ///< the query's answer
};

/// All vf and ee pairs that are nearer than `reach` at V; pairs proved to be at least that far apart are left out (kept
/// are candidates with distance_lower < reach, unless find_near_candidates() has proved more). Sorted by (kind, first,
/// second). `hierarchy` belongs to `mesh` and is refit here; `active` as in CandidateOptions. REQUIRES validate() ==
/// kNone and a finite reach >= 0. In parallel; equal bits for any thread count (K7). The same as the two halves that
/// follow, one after the other.
[[nodiscard]] std::vector<PairProximity> find_proximities(const Mesh& mesh, BoxHierarchy& hierarchy,
                                                          const PositionsRef& V, double reach,
                                                          std::span<const std::uint8_t> active = {});

/// The first half: all pairs but those that a look at many of them at once (lane_cull.h) PROVES to be at least `reach`
/// apart at V. For 15 ns a candidate of the broad phase it spares nearly all queries of 400 ns.
[[nodiscard]] Candidates find_near_candidates(const Mesh& mesh, BoxHierarchy& hierarchy, const PositionsRef& V,
                                              double reach, std::span<const std::uint8_t> active = {});
/// The second: those of `candidates` that are nearer than `reach`, in their order.
[[nodiscard]] std::vector<PairProximity> ask_proximities(const Mesh& mesh, const PositionsRef& V,
                                                         const Candidates& candidates, double reach);

}  // namespace selvage
