#include "sim/quick_proximity.h"

#include <algorithm>
#include <limits>

#include <Eigen/Geometry>

namespace selvage::sim {
namespace {

/// The origin's nearest point on the segment from a to b: its share of b.
double share_on_segment(const Vec3& a, const Vec3& b) {
  const Vec3 ab = b - a;
  return std::clamp(-a.dot(ab) / ab.squaredNorm(), 0.0, 1.0);
}

/// The nearest of the points a (1 - s) + b s on an edge of the triangle, if nearer than `best`.
void consider_edge(const std::array<Vec3, 3>& corner, std::size_t a, std::size_t b, double& best,
                   std::array<double, 3>& weights) {
  const double share = share_on_segment(corner[a], corner[b]);
  const double squared = (corner[a] + share * (corner[b] - corner[a])).squaredNorm();
  if (squared >= best) return;
  best = squared;
  weights = {};
  weights[a] = 1 - share;
  weights[b] = share;
}

/// The origin's nearest point of a triangle.
std::array<double, 3> nearest_on_triangle(const std::array<Vec3, 3>& corner) {
  const Vec3 normal = (corner[1] - corner[0]).cross(corner[2] - corner[0]);
  std::array<double, 3> areas{};
  for (std::size_t k = 0; k < 3; ++k) areas[k] = corner[(k + 1) % 3].cross(corner[(k + 2) % 3]).dot(normal);
  if (areas[0] > 0 && areas[1] > 0 && areas[2] > 0) {
    const double sum = areas[0] + areas[1] + areas[2];
    return {areas[0] / sum, areas[1] / sum, areas[2] / sum};
  }
  double best = std::numeric_limits<double>::infinity();
  std::array<double, 3> weights{};
  for (std::size_t k = 0; k < 3; ++k) consider_edge(corner, k, (k + 1) % 3, best, weights);
  return weights;
}

}  // namespace

QuickProximity quick_proximity(PairKind kind, const PairVectors& x) {
  if (kind == PairKind::kVf) {
    const auto w = nearest_on_triangle({x[1] - x[0], x[2] - x[0], x[3] - x[0]});
    return {x[0] - (w[0] * x[1] + w[1] * x[2] + w[2] * x[3]), {1, -w[0], -w[1], -w[2]}};
  }
  // The unbounded lines' nearest points, the first share bounded; then each the other's nearest in turn (Ericson).
  const Vec3 u = x[1] - x[0], v = x[3] - x[2], r = x[0] - x[2];
  const double uu = u.squaredNorm(), uv = u.dot(v), vv = v.squaredNorm(), ur = u.dot(r), vr = v.dot(r);
  const double sine_squared = uu * vv - uv * uv;
  double s = sine_squared > 0 ? std::clamp((uv * vr - ur * vv) / sine_squared, 0.0, 1.0) : 0;
  const double t = std::clamp((uv * s + vr) / vv, 0.0, 1.0);
  s = std::clamp((uv * t - ur) / uu, 0.0, 1.0);
  return {r + s * u - t * v, {1 - s, s, t - 1, -t}};
}

}  // namespace selvage::sim
