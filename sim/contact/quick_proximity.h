// Nearest points of pairs in plain doubles, without a proof: which pairs are worth a query of the kernel.
#pragma once

#include "kernel/lanes/lane_motion.h"
#include "kernel/types.h"
#include "sim/contact/interaction.h"

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

/// Those of a block of pairs, by columns.
struct QuickProximities {
  using Column = std::array<double, detail::kPairBlock + detail::kMaxLanes>;
  Column distance;
  std::array<Column, 3> direction;
  std::array<Column, 4> weights;

  [[nodiscard]] QuickProximity operator[](std::size_t i) const;
};

/// The same bits as one by one, with whatever vectors the machine has (SIMD, chosen at run time); what that saves is in
/// docs/measurements/simulator-speed.md. `V` has their vertices.
void quick_proximities(const detail::LanePairs& pairs, const Positions& V, QuickProximities& result);

}  // namespace selvage::sim
