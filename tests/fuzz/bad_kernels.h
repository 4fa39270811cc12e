// Kernels that every campaign must find out: a property that lets one of them pass says nothing.
#pragma once

#include <limits>

#include "fuzz/base/motion_query.h"

namespace selvage::fuzz {

inline CcdResult answer_with(CcdVerdict verdict, CcdCause cause, double toi_lower, double gap_bound) {
  CcdResult result;
  result.verdict = verdict;
  result.cause = cause;
  result.toi_lower = toi_lower;
  result.gap_bound = gap_bound;
  return result;
}

inline std::array<double, 4> some_weights(const MotionQuery& query) {
  return query.kind == PairKind::kEe ? std::array<double, 4>{1, 0, 1, 0} : std::array<double, 4>{1, 1, 0, 0};
}

inline CcdResult always_separated(const MotionQuery& /*query*/) {
  return answer_with(CcdVerdict::kSeparated, CcdCause::kNone, 1, 0);
}
/// Has no false negatives at all.
inline CcdResult always_collides(const MotionQuery& query) {
  CcdResult result = answer_with(CcdVerdict::kCollides, CcdCause::kMotion, 0, 0);
  result.weights = some_weights(query);
  return result;
}
/// ... and keeps its bound, which bounds nothing.
inline CcdResult always_collides_somewhere(const MotionQuery& query) {
  CcdResult result = always_collides(query);
  result.gap_bound = std::numeric_limits<double>::max();
  return result;
}
inline CcdResult always_unresolved(const MotionQuery& /*query*/) { return {}; }
/// Right in everything but the time of impact, which is the middle of the truth and the end.
inline CcdResult late(const MotionQuery& query) {
  CcdResult result = selvage_kernel(query);
  if (result.cause == CcdCause::kMotion) result.toi_lower = result.toi_lower / 2 + 0.5;
  return result;
}
/// Forgets the distance at the end.
inline CcdResult forgets_end(const MotionQuery& query) {
  const CcdResult result = selvage_kernel(query);
  return result.cause == CcdCause::kEnd ? always_separated(query) : result;
}
/// Adds a bias in the first coordinate of the first point: breaks symmetry and scale, though hardly ever an answer.
inline CcdResult biased(const MotionQuery& query) {
  MotionQuery moved = query;
  moved.x_t0[0].x() += 0x1p-30;
  return selvage_kernel(moved);
}
/// Its weights do not move with the points of an edge, of the third kind of event alone.
inline CcdResult forgets_labels(const MotionQuery& query) {
  CcdResult result = selvage_kernel(query);
  if (query.kind == PairKind::kSelf) result.weights = {1, 0.75, 0.25, 0};
  return result;
}

}  // namespace selvage::fuzz
