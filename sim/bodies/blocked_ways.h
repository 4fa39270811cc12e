// How a body goes on where cloth has no room for it (S4, squeeze = "yield"): along what is in its way, at a
// little distance, till it tries again.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "kernel/types.h"
#include "sim/base/blockage.h"
#include "sim/bodies/catch_up.h"

namespace selvage::sim {

/// A body that is led along what blocks it leaves room for a while: pressed again in every step, cloth is held between
/// micrometres, in the shortest steps. A foot that rolls over a hem, 1.5 s: 374 steps with it, 833 without, in which
/// the fail-safe held 341 vertices; standing still took 756 (docs/measurements/stability.md, *Bodies that yield*).
inline constexpr double kBlockedTime_s = kCatchUpTime_s;
/// It backs out by this share of the thickness, at a thickness in kCatchUpTime_s, as slowly as it comes back. By half
/// of that share the fail-safe held 239 vertices there, by twice of it the foot rises and falls by 4 mm.
inline constexpr double kBackShare = 0.5;
/// Of a body that deforms what is nearer than so many thicknesses to a vertex that is blocked, and goes against the
/// same blockage, is led as well, and backs out the less the farther it is. Vertices one by one are pressed in beside
/// each other: a foot of 642 vertices that slides over a hem took 695 steps and the fail-safe held 654 vertices, with
/// one thickness 572 and 944, with 2.5 484 and 11, with five 186 and none; standing still one by one 2,185 and 13,255.
inline constexpr double kReachThicknesses = 5;
/// Blockages of a later step take the place of earlier ones that are as near, from within 11 degrees: what lasts is
/// bounded by what meets, however short steps are.
inline constexpr double kSameDirection = 0.98;

struct BlockedWay {
  Blockage blockage;
  double until_s;  ///< it is none for steps from then on
  double back_m;   ///< still to back out
  friend bool operator==(const BlockedWay&, const BlockedWay&) = default;
};

/// Of all bodies.
class BlockedWays {
 public:
  explicit BlockedWays(double thickness_m) : thickness_m_(thickness_m) {}

  /// What has ended by then is forgotten.
  void start_step(double time_s);
  /// Those of bodies, or vertices of these, of which none was added in this step. False where there are none: the rest
  /// has to stand still.
  bool add(std::span<const Blockage> blockages);
  /// Whether the motion of a body's vertices in dt_s goes against a blockage, or has to back out of one. From x to
  /// x_t1, which is changed then by the least translation with which it goes against none: of the whole body where it
  /// is rigid, of each vertex where it deforms; by no more than some ten times its length, so that where blockages
  /// leave no room the caller has to see that it did not help. Rows as `vertices`, sorted. O(blockages + rows), and for
  /// each vertex within reach of one that is blocked O(blockages).
  bool lead_round(std::int32_t body, std::span<const VertexId> vertices, const Positions& x, double dt_s,
                  Positions& x_t1) const;
  /// It is taken.
  void end_step(double dt_s);

  [[nodiscard]] const std::vector<BlockedWay>& all() const { return ways_; }
  /// Between steps.
  void restore(std::vector<BlockedWay> ways) { ways_ = std::move(ways); }

 private:
  /// How far a body backs out in a step.
  [[nodiscard]] double back_m(const BlockedWay& way, double dt_s) const;
  bool lead_vertices_round(std::span<const BlockedWay> ways, std::span<const VertexId> vertices, const Positions& x,
                           double dt_s, Positions& x_t1) const;

  double thickness_m_;
  std::vector<BlockedWay> ways_;
  std::size_t at_start_ = 0;  ///< of them, from earlier steps
  double time_s_ = 0;
};

}  // namespace selvage::sim
