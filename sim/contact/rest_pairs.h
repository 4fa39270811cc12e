// Pairs of one cloth that are nearer at rest than it is thick, as neighbours are where edges are shorter than about 1.4
// thicknesses. Held a thickness apart they would inflate it: a free sheet of 20 x 20 vertices grew to 1.3 times its
// size where its edges were as long as it was thick, and to 4.2 times where they were a third of that.
#pragma once

#include <cstdint>
#include <vector>

#include "kernel/mesh.h"

namespace selvage::sim {

/// Repels below its distance at rest; of kSelf, which does not repel, the tolerance alone is held to that.
struct RestPair {
  PairKind kind = PairKind::kVf;
  std::int32_t first = 0, second = 0;  ///< vertex and face, its own for kSelf; edge and an edge with a higher number
  double distance_m = 0;               ///< >= 0

  friend bool operator==(const RestPair&, const RestPair&) = default;
};

/// All pairs of `mesh`, its faces' own included, that are nearer than `thickness_m` in the rest shape V_rest; sorted by
/// kind, first and second. Of one cloth: two cloths repel at their whole thickness, wherever their rest shapes lie.
/// None where the positions are invalid. Time and memory O(n + pairs), beside that of a broad phase; once for a cloth.
/// REQUIRES thickness_m >= 0, finite.
[[nodiscard]] std::vector<RestPair> find_rest_pairs(const Mesh& mesh, const PositionsRef& V_rest, double thickness_m);

/// kNone, kBadSurfaces (no pair of the mesh, or one of kVf or kEe whose features share a vertex), or kBadOption (a
/// distance out of its range).
[[nodiscard]] InputError validate(const Mesh& mesh, const std::vector<RestPair>& pairs);

/// Looks them up.
class RestDistances {
 public:
  RestDistances() = default;
  /// In any order; of those that name the same pair the smallest holds. O(#V + #E + n log n). REQUIRES valid pairs.
  RestDistances(const Mesh& mesh, std::vector<RestPair> pairs);

  [[nodiscard]] bool empty() const { return pairs_.empty(); }
  /// m; infinity for a pair that is none of them. O(log of those with the same `first`).
  [[nodiscard]] double of(PairKind kind, std::int32_t first, std::int32_t second) const;

 private:
  [[nodiscard]] std::size_t row(PairKind kind, std::int32_t first) const;

  std::size_t vertex_count_ = 0;
  std::vector<RestPair> pairs_;     ///< sorted
  std::vector<std::size_t> begin_;  ///< of those of each vertex, then of each edge; one more at the end
};

}  // namespace selvage::sim
