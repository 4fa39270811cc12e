// The origin passes through the plane of the difference polygon: inside the polygon, the features pass through each
// other; outside, they pass beside. Nearly every query that the cull leaves is one of the two, and plain doubles tell.
#pragma once

#include "kernel/pair_motion.h"

namespace selvage::detail {

/// The point of the polygon's plane that is nearest to the origin, where the polygon spans one. Computed without a
/// proof, in one step: good to rounding times the condition of the polygon.
struct PlaneCrossing {
  std::array<double, 4> weights = {};  ///< of the points of the pair, as in ClosestPoint, but of either sign
  Double3 normal;                      ///< edge_u x edge_v
  /// From the point to the border of the polygon at least, negative outside; NaN where there is no plane.
  double depth = 0;
  /// Outside: within the plane, orthogonal to an edge that the point is beyond, away from the polygon. Not normalised.
  Double3 outward;
};

/// REQUIRES kind kVf or kEe.
[[nodiscard]] PlaneCrossing plane_crossing(PairKind kind, const DifferencePolygon<double>& polygon);

}  // namespace selvage::detail
