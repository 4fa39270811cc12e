// What a batch may leave out although its single query does not call it separated (ccd_batch.h).
#pragma once

#include "kernel/collisions.h"

namespace selvage::testing {

/// The pair's query, but with the default limit of intervals.
inline CcdResult ask_without_limit(const Mesh& mesh, const PositionsRef& V_t0, const PositionsRef& V_t1,
                                   const Collision& pair, double tolerance) {
  const auto vertices = pair_vertices(mesh, pair.kind, pair.first, pair.second);
  std::array<Vec3, 4> x_t0, x_t1;
  for (std::size_t k = 0; k < 4; ++k) {
    x_t0[k] = V_t0.row(vertices[k]);
    x_t1[k] = V_t1.row(vertices[k]);
  }
  return (pair.kind == PairKind::kVf ? vf_ccd : ee_ccd)(x_t0, x_t1, {tolerance, CcdOptions{}.max_intervals});
}

/// Whether it is a pair on which its query gives up, or cannot tell the distance at the end from the tolerance. Without
/// the limit it says so itself.
inline bool may_be_left_out(const Mesh& mesh, const PositionsRef& V_t0, const PositionsRef& V_t1, const Collision& pair,
                            double tolerance) {
  if (pair.kind == PairKind::kSelf) return false;
  const CcdResult without_limit = ask_without_limit(mesh, V_t0, V_t1, pair, tolerance);
  if (without_limit.verdict == CcdVerdict::kSeparated) return pair.ccd.intervals < without_limit.intervals;
  return without_limit.cause == CcdCause::kEnd && without_limit.gap_bound > tolerance;
}

}  // namespace selvage::testing
