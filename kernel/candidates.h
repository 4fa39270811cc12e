// Which pairs to test: features whose swept, enlarged boxes overlap. Sorted and without repeats, so results compare
// with ==.
#pragma once

#include <compare>
#include <cstdint>
#include <span>
#include <vector>

#include "kernel/mesh.h"

namespace selvage {

struct VfCandidate {
  VertexId vertex;
  FaceId face;
  friend auto operator<=>(const VfCandidate&, const VfCandidate&) = default;
};
struct EeCandidate {  ///< a < b, no shared vertex
  EdgeId a, b;
  friend auto operator<=>(const EeCandidate&, const EeCandidate&) = default;
};
struct Candidates {
  std::vector<VfCandidate> vf;
  std::vector<EeCandidate> ee;
  friend bool operator==(const Candidates&, const Candidates&) = default;
};

struct CandidateOptions {
  /// Each feature's box is grown by half of this, rounded outward: pairs nearer than `reach` at any common box are
  /// found.
  double reach = 0;
  /// #V flags, or empty for "all": a pair counts only if one of its vertices is active. Scripted bodies against
  /// each other, and pairs that a response did not touch, cost nothing.
  std::span<const std::uint8_t> active;
};

/// O(#V #F + #E^2): the reference for every other broad phase (K6).
[[nodiscard]] Candidates find_candidates_brute_force(const Mesh& mesh, const PositionsRef& V_t0,
                                                     const PositionsRef& V_t1, const CandidateOptions& options);

}  // namespace selvage
