// Proximities and collisions of a whole mesh: broad phase, then the queries, in parallel, in a fixed order (K7).
#pragma once

#include <vector>

#include "kernel/box_hierarchy.h"
#include "kernel/ccd.h"
#include "kernel/proximity.h"

namespace selvage {

struct Collision {
  PairKind kind;
  std::int32_t first, second;  ///< vertex, face | edge, edge | vertex, its own face
  CcdResult ccd;
};
struct CollisionReport {
  std::vector<Collision> collisions;  ///< not separated; sorted by (kind, first, second)
  double toi_lower = 1;               ///< PROVED: the whole mesh is free of touch on [0, toi_lower)
  std::int64_t vf_candidates = 0, ee_candidates = 0, self_candidates = 0, intervals = 0;  ///< deterministic
};
struct PairProximity {
  PairKind kind;
  std::int32_t first, second;
  std::array<VertexId, 4> vertices;  ///< in the order of vf_proximity / ee_proximity
  Proximity proximity;
};

/// The vertices of a pair in query order: {p, a, b, c}, {a, b, c, d}, or {p, a, b, p} for kSelf.
[[nodiscard]] std::array<VertexId, 4> pair_vertices(const Mesh& mesh, PairKind kind, std::int32_t first,
                                                    std::int32_t second);

/// All pairs that are not proved separated over the step. All three kinds of events. REQUIRES validate() == kNone.
/// `hierarchy` belongs to `mesh` and is refit here; `active` as in CandidateOptions.
[[nodiscard]] CollisionReport find_collisions(const Mesh& mesh, BoxHierarchy& hierarchy, const PositionsRef& V_t0,
                                              const PositionsRef& V_t1, const CcdOptions& options,
                                              std::span<const std::uint8_t> active = {});
/// All vf and ee pairs nearer than `reach` at V (distance_lower < reach), sorted by (kind, first, second).
[[nodiscard]] std::vector<PairProximity> find_proximities(const Mesh& mesh, BoxHierarchy& hierarchy,
                                                          const PositionsRef& V, double reach,
                                                          std::span<const std::uint8_t> active = {});

}  // namespace selvage
