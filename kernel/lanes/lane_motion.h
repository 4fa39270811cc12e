// Candidates and their vertices' motion as SIMD lanes read them (lane_cull.h, plane_passage.h).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "kernel/candidates.h"

namespace selvage::detail {

/// Pairs that are looked at together: enough that the few that one look leaves fill the lanes of the next.
inline constexpr std::size_t kPairBlock = 1024;
/// Lanes of the widest target: of floats, and of doubles.
inline constexpr std::size_t kMaxLanes = 16, kMaxWideLanes = 8;

/// Places of pairs in a block, ascending, with room for a whole vector behind them.
struct PairNumbers {
  std::array<std::uint32_t, kPairBlock + kMaxLanes> place;
  std::size_t count = 0;

  PairNumbers() {}  // places are written before they are read
  void add(std::uint32_t number) { place[count++] = number; }
};

/// The vertices of at most kPairBlock pairs of one kind, in query order.
class LanePairs {
 public:
  /// REQUIRES pairs of the mesh.
  LanePairs(const Mesh& mesh, std::span<const VfCandidate> pairs);
  LanePairs(const Mesh& mesh, std::span<const EeCandidate> pairs);
  /// Some of `all`.
  LanePairs(const LanePairs& all, const PairNumbers& numbers);

  [[nodiscard]] PairKind kind() const { return kind_; }
  [[nodiscard]] std::size_t count() const { return count_; }
  /// The k'th vertex of each pair; at the end the last one again, as often as a vector has lanes.
  [[nodiscard]] const std::uint32_t* vertices(std::size_t k) const { return vertex_[k].data(); }

 private:
  void pad();

  PairKind kind_;
  std::size_t count_;
  std::array<std::array<std::uint32_t, kPairBlock + kMaxLanes>, 4> vertex_;
};

class LaneMotion {
 public:
  /// O(#V).
  [[gnu::noinline]] LaneMotion(const PositionsRef& V_t0, const PositionsRef& V_t1);

  /// False where a coordinate is outside the domain: the lanes have nothing to say then.
  [[nodiscard]] bool is_valid() const { return is_valid_; }
  /// Whether scaling has moved no coordinate near underflow: differences of rows, scaled again, have the bits of scaled
  /// differences of the positions themselves.
  [[nodiscard]] bool is_exact() const { return is_exact_; }

  struct alignas(64) Row : std::array<double, 8> {};  ///< one cache line
  /// Of each vertex: x, y, z at t = 0, then at t = 1, scaled by 2^-exponent so that the largest is in [0.5, 1); 0, 0.
  std::vector<Row> rows;
  int exponent = 0;

  struct alignas(32) NearRow : std::array<float, 8> {};
  /// The same from the middle of the mesh, scaled by 2^-near_exponent, in float32: x, y, z, 0 at t = 0, then at t = 1,
  /// at most 1. Their errors are part of kNearError (rounding.h).
  std::vector<NearRow> near_rows;
  int near_exponent = 0;

 private:
  void fill_rows(const PositionsRef& V_t0, const PositionsRef& V_t1);
  void fill_near_rows();

  bool is_valid_ = true, is_exact_ = true;
};

}  // namespace selvage::detail
