#include "kernel/plane_crossing.h"

namespace selvage::detail {

// The point is r + alpha u + beta v with r = corner[0]; n = u x v, so that alpha n^2 = (v x r) . n and
// beta n^2 = (r x u) . n. Each edge of the polygon is at alpha or beta = 0, or at alpha + beta = 1 (vf), or alpha or
// beta = 1 (ee). An edge e with the polygon to its left, seen from n, has n x e pointing inward.
PlaneCrossing plane_crossing(PairKind kind, const DifferencePolygon<double>& polygon) {
  const Double3 &r = polygon.corner[0], &u = polygon.edge_u, &v = polygon.edge_v;
  PlaneCrossing result;
  const Double3& n = result.normal = cross(u, v);
  const double n_squared = dot(n, n);
  const double alpha = dot(cross(v, r), n) / n_squared, beta = dot(cross(r, u), n) / n_squared;
  double longest_squared = std::max(dot(u, u), dot(v, v));
  double least = alpha;          // how far inside, as a share of the height over the edge that is nearest in this sense
  Double3 across = v, tail = n;  // outward = across x tail
  const auto consider = [&](double share, const Double3& first, const Double3& second) {
    if (!(share < least)) return;
    least = share;
    across = first;
    tail = second;
  };
  consider(beta, n, u);
  if (kind == PairKind::kVf) {
    result.weights = {1, 1 - alpha - beta, alpha, beta};
    longest_squared = std::max(longest_squared, dot(polygon.edge_w, polygon.edge_w));
    consider(result.weights[1], n, polygon.edge_w);
  } else {
    result.weights = {1 - alpha, alpha, 1 - beta, beta};
    consider(result.weights[0], n, v);
    consider(result.weights[2], u, n);
  }
  result.depth = least * std::sqrt(n_squared / longest_squared);
  result.outward = cross(across, tail);
  return result;
}

}  // namespace selvage::detail
