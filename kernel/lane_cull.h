// A cull for whole lists of candidates, one pair a lane (SIMD, chosen at run time; same decisions on every target).
// It asks the question of cull.h, with simpler bounds: the points themselves are projected, and errors are relative to
// the largest coordinate of the mesh, not to the pair. What it leaves is asked again, pair by pair.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "kernel/candidates.h"

namespace selvage::detail {

/// Pairs that are looked at together: enough that the few that one look leaves fill the lanes of the next.
inline constexpr std::size_t kPairBlock = 512;
/// Lanes of the widest target: numbers are written in whole vectors.
inline constexpr std::size_t kCullLanes = 8;

/// A mesh in motion as the lanes read it.
class LaneMotion {
 public:
  /// O(#V + #E + #F).
  LaneMotion(const Mesh& mesh, const PositionsRef& V_t0, const PositionsRef& V_t1);

  /// False where a coordinate is outside the domain: the lanes have nothing to say then.
  [[nodiscard]] bool is_valid() const { return is_valid_; }

  struct alignas(64) Row : std::array<double, 8> {};  ///< one cache line
  /// Of each vertex: x, y, z at t = 0, then at t = 1, scaled by 2^-exponent so that the largest is in [0.5, 1); 0, 0.
  std::vector<Row> rows;
  int exponent = 0;
  /// Vertex numbers in 32 bits each, the first in the low half: of an edge one word, of a face two.
  std::vector<std::uint64_t> edge_words, face_words;

 private:
  bool is_valid_ = true;
};

using PairNumbers = std::array<std::uint64_t, kPairBlock + kCullLanes>;

/// Writes the places of those `pairs` (at most kPairBlock) that are not PROVED free of touch in [0,1] and farther apart
/// than `tolerance` at t = 1, in ascending order; returns their number. REQUIRES motion.is_valid(), pairs of its mesh,
/// a finite tolerance >= 0, and the environment of FpEnvGuard.
std::size_t cull_in_lanes(const LaneMotion& motion, std::span<const VfCandidate> pairs, double tolerance,
                          PairNumbers& left);
std::size_t cull_in_lanes(const LaneMotion& motion, std::span<const EeCandidate> pairs, double tolerance,
                          PairNumbers& left);

}  // namespace selvage::detail
