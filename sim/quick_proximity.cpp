#include "sim/quick_proximity.h"

#include <algorithm>
#include <limits>

#include <Eigen/Geometry>

#include "sim/power_of_two.h"

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

/// Weights of the nearest points of a vertex at the origin and a face.
std::array<double, 4> vf_weights(const std::array<Vec3, 3>& face) {
  const auto w = nearest_on_triangle(face);
  return {1, -w[0], -w[1], -w[2]};
}

/// Of an edge from the origin to b and one from c to d: the unbounded lines' nearest points, the first share bounded;
/// then each the other's nearest in turn (Ericson).
std::array<double, 4> ee_weights(const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 v = d - c;
  const double uu = b.squaredNorm(), uv = b.dot(v), vv = v.squaredNorm(), ur = -b.dot(c), vr = -v.dot(c);
  const double sine_squared = uu * vv - uv * uv;
  double s = sine_squared > 0 ? std::clamp((uv * vr - ur * vv) / sine_squared, 0.0, 1.0) : 0;
  const double t = std::clamp((uv * s + vr) / vv, 0.0, 1.0);
  s = std::clamp((uv * t - ur) / uu, 0.0, 1.0);
  return {1 - s, s, t - 1, -t};
}

}  // namespace

QuickProximity quick_proximity(PairKind kind, const PairVectors& x) {
  std::array<Vec3, 3> y{x[1] - x[0], x[2] - x[0], x[3] - x[0]};
  double largest = 0;
  for (const Vec3& v : y) largest = std::max(largest, v.cwiseAbs().maxCoeff());
  const double scale = power_of_two_above(largest);  // products of four lengths neither overflow nor vanish
  for (Vec3& v : y) v /= scale;
  const auto weights = kind == PairKind::kVf ? vf_weights(y) : ee_weights(y[0], y[1], y[2]);
  const Vec3 difference = weights[1] * y[0] + weights[2] * y[1] + weights[3] * y[2];
  const double distance = difference.norm();
  return {distance * scale, difference / distance, weights};
}

}  // namespace selvage::sim
