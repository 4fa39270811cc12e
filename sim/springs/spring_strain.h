// How far springs are strained, and whether by contact: where a collision step is long beside the swing of the springs,
// the dynamics carries a vertex on in it that contact then puts back, and the springs between are pressed.
#pragma once

#include <array>
#include <cstdint>

#include "sim/springs/spring.h"

namespace selvage::sim {

struct StrainedMotion {
  PositionsRef x_t0, candidate, x_t1;  ///< at the start, after the dynamics, after the collision step
};

/// Structural and shear springs that are strained by more than before, by a fifth of the limit or more: beyond 1.5
/// limits by the collision step alone, or beyond 3 by the whole step. 0 without a limit. O(springs), in parallel.
[[nodiscard]] std::int64_t springs_overstrained(const SpringSystem& springs, double strain_limit,
                                                const StrainedMotion& motion);

/// A change of length over the length at rest, and between which vertices: none where it is 0.
struct Strained {
  double strain = 0;
  std::array<VertexId, 2> ends = {-1, -1};
};

/// Of structural and shear springs: the one that is strained most, the first of several. O(springs), in parallel.
[[nodiscard]] Strained most_strained(const SpringSystem& springs, const PositionsRef& x);

/// The same without those that are shorter than at rest, and its strain alone.
[[nodiscard]] double largest_elongation(const SpringSystem& springs, const PositionsRef& x);

}  // namespace selvage::sim
