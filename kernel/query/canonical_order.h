// One labelling for all labellings of the same pair: corners sorted by their stored coordinates, so that relabelling
// cannot change a bit of the answer (K5).
#pragma once

#include <array>

#include "kernel/arithmetic/vec3.h"

namespace selvage::detail {

struct CanonicalOrder {
  std::array<std::uint8_t, 4> original = {0, 1, 2, 3};  ///< canonical place i holds the caller's point original[i]
  bool features_swapped = false;                        ///< ee: the second edge came first, so normals change sign
};

/// Sorts a, b, c (vf); the ends of each edge, then the edges (ee); a, b (self): by x_t0, then x_t1. Points that are
/// equal in all bits are interchangeable.
[[nodiscard]] CanonicalOrder canonical_order(PairKind kind, const Vec3* x_t0, const Vec3* x_t1);

[[nodiscard]] std::array<double, 4> restore_weights(const CanonicalOrder& order, const std::array<double, 4>& weights);
[[nodiscard]] Vec3 restore_normal(const CanonicalOrder& order, const Double3& normal);

}  // namespace selvage::detail
