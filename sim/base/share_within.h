// How far a step may go before it leaves a ball about the origin.
#pragma once

#include <algorithm>
#include <cmath>

#include "kernel/types.h"

namespace selvage::sim {

/// The largest share in [0, 1] of `step` from `start` that ends within a ball about the origin, of which the squared
/// radius is `room` >= 0 above that of `start`.
[[nodiscard]] inline double share_within(const Vec3& start, const Vec3& step, double room) {
  const double along = start.dot(step), square = step.squaredNorm();
  if (!(square > 0)) return 1;
  // The positive root of |start + s step| = radius, as a sum of numbers of one sign where the step leads outwards.
  const double root = std::sqrt(along * along + square * room);
  const double share = along > 0 ? room / (root + along) : (root - along) / square;
  return std::min(share, 1.0);
}

}  // namespace selvage::sim
