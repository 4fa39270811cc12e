// Collisions of a whole mesh: broad phase, then the queries, in parallel, in a fixed order (K7).
#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "kernel/box_hierarchy.h"
#include "kernel/ccd.h"

namespace selvage {

/// A pair that is not proved separated.
struct Collision {
  PairKind kind;        ///< what `first` and `second` number
  std::int32_t first;   ///< vertex | edge | vertex
  std::int32_t second;  ///< face | edge | the vertex's own face
  CcdResult ccd;        ///< the query's answer
};
/// All collisions of a step.
struct CollisionReport {
  std::vector<Collision> collisions;  ///< not separated; sorted by (kind, first, second)
  double toi_lower = 1;               ///< PROVED: no pair with an active vertex touches in [0, toi_lower)
  std::int64_t vf_candidates = 0;     ///< vertex-face queries made
  std::int64_t ee_candidates = 0;     ///< edge-edge queries made
  std::int64_t self_candidates = 0;   ///< queries made of vertices against their faces' opposite edges
  std::int64_t intervals = 0;         ///< time intervals they examined: a deterministic measure of work
  bool is_complete = true;            ///< or there are more than the caller wants to know: see find_collisions()
};

/// What a search for collisions may take.
struct CollisionLimits {
  /// Candidates that are listed before they are asked; more are asked as they are found. The default takes half a
  /// gigabyte: as found, and listed.
  std::size_t most_listed = std::size_t{1} << 25;
  /// Where more than so many pairs are not proved free of touch (kMotion), the search is given up.
  std::size_t most_collisions = std::numeric_limits<std::size_t>::max();
  /// Likewise where more than so many are free of touch, but not proved farther apart than tolerance at the end (kEnd).
  std::size_t most_near = std::numeric_limits<std::size_t>::max();
};

/// How many candidates of swept boxes find_collisions() lists before it tries moving boxes: where there are more, the
/// motion is long beside the features, or much is near.
[[nodiscard]] std::size_t few_candidates(const Mesh& mesh);

/// All pairs that are not proved separated over the step: vf, ee, and each vertex against the opposite edge of each
/// face that holds it (kSelf: touching in [0,1], or within tolerance at t = 1, like any other pair). Pairs without an
/// active vertex are left out. Queries are spent on pairs whose boxes, grown by half the tolerance, overlap
/// (candidates.h); the boxes of all other pairs are proof enough. They are swept over the step for kSelf. For vf and ee
/// they are, too, up to few_candidates(), and moving boxes beyond; what is not separated has passed moving boxes in
/// either case, and is answered as by CcdBatch. toi_lower covers every vf, ee and kSelf pair with an active vertex,
/// candidate or not. A step without motion (V_t0 = V_t1) is a step: pairs within tolerance are found, touching ones
/// with toi_lower 0. `hierarchy` belongs to `mesh` (fits() is asked) and is refit here; `active` as in
/// CandidateOptions. REQUIRES validate() == kNone of the positions and of the options, which it asks. In parallel;
/// results are ordered, and equal bits for any thread count (K7). Memory is O(#V + #F + most_listed + collisions),
/// also where features cross in the step so far that there are O(#F^2) candidates, and it takes as long, unless
/// `limits` ends it: then the report is not complete, names none, and has a toi_lower of 0.
[[nodiscard]] CollisionReport find_collisions(const Mesh& mesh, BoxHierarchy& hierarchy, const PositionsRef& V_t0,
                                              const PositionsRef& V_t1, const CcdOptions& options,
                                              std::span<const std::uint8_t> active = {},
                                              const CollisionLimits& limits = {});

}  // namespace selvage
