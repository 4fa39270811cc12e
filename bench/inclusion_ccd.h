// Interval subdivision, as inclusion-based CCD does it (Wang, Ferguson, Schneider, Jiang, Attene, Panozzo, "A
// large-scale benchmark and an inclusion-based algorithm for continuous collision detection", 2021, section 4).
//   The difference F(t, u, v) of a point of one feature and a point of the other, at time t, is linear in each of t, u
//   and v, so its values over a box of them lie in the hull of its 8 corner values. Boxes whose corner values leave out
//   0 along an axis, by more than the rounding bound, are dropped; others are split, level by level, across the
//   direction in which F may vary most, until F varies by at most `tolerance` of the query's size.
//
// It misses nothing and is never late: the only way to drop a part of the domain is the bounded comparison. An alarm
// may be a pair whose features come within sqrt(3) tolerance and the rounding bound, along the axes; its time is early
// by as much as it takes them to come from there. The bound is relative to the largest coordinate, not to the query's
// size: far from the origin alarms grow.
#pragma once

#include <array>

#include "kernel/types.h"

namespace selvage::bench {

struct InclusionOptions {
  double tolerance = 1e-6;           ///< share of the query's size, >= 0
  std::int32_t max_boxes = 1 << 12;  ///< when reached, an alarm at the earliest time that was not excluded
};

struct InclusionAnswer {
  bool collides = false;
  bool gave_up = false;  ///< max_boxes was reached
  double toi = 1;        ///< no touch in [0, toi); 1 where it does not collide
};

/// x = {p, a, b, c}. Answers gave_up at 0 where a coordinate is not finite or above kMaxCoordinate.
[[nodiscard]] InclusionAnswer inclusion_vf(const std::array<Vec3, 4>& x_t0, const std::array<Vec3, 4>& x_t1,
                                           const InclusionOptions& options);
/// x = {a, b, c, d}: edge (a, b) against edge (c, d).
[[nodiscard]] InclusionAnswer inclusion_ee(const std::array<Vec3, 4>& x_t0, const std::array<Vec3, 4>& x_t1,
                                           const InclusionOptions& options);

}  // namespace selvage::bench
