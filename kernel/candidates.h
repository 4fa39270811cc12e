// Which pairs to test: features whose enlarged boxes overlap in a motion. Sorted and without repeats, so results
// compare with ==.
#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "kernel/box.h"
#include "kernel/mesh.h"

namespace selvage {

/// A vertex and a face that does not hold it.
struct VfCandidate {
  VertexId vertex;  ///< the first in the order of pairs
  FaceId face;      ///< the second
  /// By vertex, then face.
  friend auto operator<=>(const VfCandidate&, const VfCandidate&) = default;
};
/// Two edges without a common vertex.
struct EeCandidate {
  EdgeId a;  ///< the lower-numbered
  EdgeId b;  ///< the higher-numbered
  /// By a, then b.
  friend auto operator<=>(const EeCandidate&, const EeCandidate&) = default;
};
/// What a broad phase answers.
struct Candidates {
  std::vector<VfCandidate> vf;  ///< sorted, without repeats
  std::vector<EeCandidate> ee;  ///< sorted, without repeats
  /// Pair by pair.
  friend bool operator==(const Candidates&, const Candidates&) = default;
};

/// What is called with a part of them. The parts hold every candidate once, in no order; calls come from several
/// threads at once. It may run parallel code of its own.
using CandidateVisitor = std::function<void(const Candidates& part)>;

/// What counts as a candidate.
struct CandidateOptions {
  /// Each feature's box is grown by half of this, rounded outward: pairs that come nearer than `reach` are found.
  /// Finite, >= 0.
  double reach = 0;
  /// #V flags, or empty for "all": a pair counts only if one of its vertices is active. Scripted bodies against
  /// each other, and pairs that a response did not touch, cost nothing.
  std::span<const std::uint8_t> active;
  /// kMoving finds fewer, the more the longer the motion is that features share, and leaves out none that come nearer
  /// than `reach`.
  MotionBoxes boxes = MotionBoxes::kSwept;
};

/// The vertices of a pair in query order: {p, a, b, c}.
[[nodiscard]] inline std::array<VertexId, 4> pair_vertices(const Mesh& mesh, const VfCandidate& pair) {
  const auto& corners = mesh.faces[static_cast<std::size_t>(pair.face)];
  return {pair.vertex, corners[0], corners[1], corners[2]};
}
/// {a, b, c, d}, the ends of both edges.
[[nodiscard]] inline std::array<VertexId, 4> pair_vertices(const Mesh& mesh, const EeCandidate& pair) {
  const auto &a = mesh.edges[static_cast<std::size_t>(pair.a)], &b = mesh.edges[static_cast<std::size_t>(pair.b)];
  return {a[0], a[1], b[0], b[1]};
}

/// As these, or {p, a, b, p} for kSelf, of a vertex and a face that holds it.
[[nodiscard]] std::array<VertexId, 4> pair_vertices(const Mesh& mesh, PairKind kind, std::int32_t first,
                                                    std::int32_t second);

/// O(#V #F + #E^2): the reference for every other broad phase (K6).
[[nodiscard]] Candidates find_candidates_brute_force(const Mesh& mesh, const PositionsRef& V_t0,
                                                     const PositionsRef& V_t1, const CandidateOptions& options);

}  // namespace selvage
