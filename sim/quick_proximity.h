// Nearest points of a pair in plain doubles, without a proof: which pairs are worth a query of the kernel.
#pragma once

#include "kernel/types.h"
#include "sim/interaction.h"

namespace selvage::sim {

struct QuickProximity {
  double distance;
  Vec3 direction;                 ///< unit, from the second feature's nearest point to the first's
  std::array<double, 4> weights;  ///< signed, as in Interaction: the sum of weights[i] x[i] is distance direction
};

/// `x` in the order of pair_vertices(), kind kVf or kEe. Distances are right to rounding relative to the coordinates,
/// but for features of no size (NaN) and nearly parallel edges, where any of the nearest points is one. Lengths times a
/// power of two give the same bits, scaled. A twentieth of the query's cost.
[[nodiscard]] QuickProximity quick_proximity(PairKind kind, const PairVectors& x);

}  // namespace selvage::sim
