// One labelling for all labellings of the same pair: corners sorted by their stored coordinates, so that relabelling
// cannot change a bit of the answer (K5). Points with equal coordinates are interchangeable.
#pragma once

#include <array>

#include "kernel/vec3.h"

namespace selvage::detail {

/// Positions of a pair's points at both ends in canonical order, and the way back.
struct CanonicalPair {
  std::array<Double3, 4> x_t0, x_t1;
  std::array<int, 4> original;    ///< canonical place i holds the caller's point original[i]
  bool features_swapped = false;  ///< ee: the second edge came first, so normals change sign
};

[[nodiscard]] CanonicalPair canonical_order(PairKind kind, const std::array<Double3, 4>& x_t0,
                                            const std::array<Double3, 4>& x_t1);

[[nodiscard]] std::array<double, 4> restore_weights(const CanonicalPair& pair, const std::array<double, 4>& weights);
[[nodiscard]] Double3 restore_normal(const CanonicalPair& pair, const Double3& normal);

}  // namespace selvage::detail
