// The geometric shrinker: makes a failing query simple enough to read and to think about.
#pragma once

#include <cstdint>
#include <functional>

#include "fuzz/base/motion_query.h"

namespace selvage::fuzz {

struct Shrunk {
  MotionQuery query;
  std::int64_t trials = 0;  ///< calls of still_fails
};

/// Tries, until nothing more is accepted or after `max_trials`: stop everything, move a vertex to the origin, stop a
/// vertex, put a vertex on another one, zero a coordinate, copy it from the other end or from another coordinate, round
/// it to few bits, scale by a power of two, simplify the options. Accepts what is cheaper and still fails.
/// Deterministic.
[[nodiscard]] Shrunk shrink(const MotionQuery& query, const std::function<bool(const MotionQuery&)>& still_fails,
                            std::int64_t max_trials = 20000);

/// What shrinking makes smaller, first things first: non-zero coordinates, different ones among them, bits of mantissa,
/// size of exponents.
struct QueryCost {
  int non_zero = 0, distinct = 0, moving = 0, bits = 0, exponents = 0;
  friend auto operator<=>(const QueryCost&, const QueryCost&) = default;
};
[[nodiscard]] QueryCost cost_of(const MotionQuery& query);

}  // namespace selvage::fuzz
