// Nearest points of a pair in plain doubles, without a proof: which pairs are worth a query of the kernel.
#pragma once

#include "kernel/types.h"
#include "sim/interaction.h"

namespace selvage::sim {

struct QuickProximity {
  Vec3 difference;                ///< the first feature's nearest point minus the second's
  std::array<double, 4> weights;  ///< signed, as in Interaction: `difference` is the sum of weights[i] x[i]
};

/// `x` in the order of pair_vertices(), kind kVf or kEe. Distances are right to rounding relative to the coordinates,
/// but for features of no size (NaN) and nearly parallel edges, where any of the nearest points is one. A twentieth of
/// the query's cost.
[[nodiscard]] QuickProximity quick_proximity(PairKind kind, const PairVectors& x);

}  // namespace selvage::sim
