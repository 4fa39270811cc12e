#include "kernel/closest_point.h"

#include <bit>
#include <limits>

#include "kernel/rounding.h"

namespace selvage::detail {

namespace {

using Weights = std::array<double, kMaxCorners>;  // one a corner

struct Edge {
  std::size_t first, second;  // corner[second] - corner[first] = vector
  const Double3* vector;
};

struct Candidate {
  Weights weights = {};
  Double3 point;
  double distance_squared = std::numeric_limits<double>::infinity();
  Double3 direction;
};

double clamp_unit(double t) { return t > 0 ? (t < 1 ? t : 1) : 0; }  // NaN gives 0

Double3 weighted_sum(const DifferencePolygon& polygon, const Weights& w) {
  const auto& c = polygon.corner;
  return (w[0] * c[0] + w[1] * c[1]) + (w[2] * c[2] + w[3] * c[3]);
}

void keep_nearer(Candidate& best, const Candidate& candidate) {
  if (candidate.distance_squared < best.distance_squared) best = candidate;
}

Candidate on_corner(const DifferencePolygon& polygon, std::size_t i) {
  Candidate result;
  result.weights[i] = 1;
  result.point = polygon.corner[i];
  result.direction = result.point;
  result.distance_squared = dot(result.point, result.point);
  return result;
}

/// Foot of the perpendicular on an edge, seen from its nearer end. Orthogonalising the foot once more against the edge
/// makes it a direction that is good to rounding however small the distance is (Kahan: twice is enough).
Candidate on_edge(const DifferencePolygon& polygon, const Edge& edge) {
  Candidate result;
  const Double3& e = *edge.vector;
  const double length_squared = dot(e, e);
  const Double3& p = polygon.corner[edge.first];
  const Double3& q = polygon.corner[edge.second];
  const double from_first = -dot(p, e) / length_squared;
  if (!(from_first > 0 && from_first < 1)) return result;  // a corner is nearer; zero length divides to NaN or infinity
  double t = from_first;
  Double3 foot;
  if (t <= 0.5) {
    foot = p + t * e;
  } else {
    const double from_second = clamp_unit(dot(q, e) / length_squared);
    t = 1 - from_second;
    foot = q - from_second * e;
  }
  result.weights[edge.first] = 1 - t;
  result.weights[edge.second] = t;
  result.direction = foot - (dot(foot, e) / length_squared) * e;
  result.point = foot;
  result.distance_squared = dot(foot, foot);
  return result;
}

struct PlaneFrame {
  Double3 u, v_across;  // v_across = v - shear u, orthogonal to u
  double u_squared, v_squared, shear;
  bool valid;
};

PlaneFrame make_frame(const Double3& u, const Double3& v) {
  PlaneFrame frame{u, v, dot(u, u), 0, 0, false};
  if (!(frame.u_squared > 0)) return frame;
  for (int pass = 0; pass < 2; ++pass) {
    const double k = dot(u, frame.v_across) / frame.u_squared;
    frame.v_across = frame.v_across - k * u;
    frame.shear += k;
  }
  frame.v_squared = dot(frame.v_across, frame.v_across);
  frame.valid = frame.v_squared > 0;
  return frame;
}

/// A normal of the frame, accurate against both edges even where u x v has cancelled.
Double3 frame_normal(const PlaneFrame& frame) {
  Double3 n = normalize_exponent(cross(frame.u, frame.v_across));
  for (int pass = 0; pass < 2; ++pass) {
    n = n - (dot(n, frame.u) / frame.u_squared) * frame.u;
    n = n - (dot(n, frame.v_across) / frame.v_squared) * frame.v_across;
  }
  return n;
}

/// Steps of the least-squares problem min |corner[0] + alpha u + beta v|; the residual is recomputed from the corners,
/// so each pass shrinks the error by the condition of the frame times u.
Candidate in_interior(PairKind kind, const DifferencePolygon& polygon) {
  Candidate result;
  const PlaneFrame frame = make_frame(polygon.edge_u, polygon.edge_v);
  if (!frame.valid) return result;
  double alpha = 0, beta = 0;
  Double3 point = polygon.corner[0];
  for (int pass = 0; pass < 3; ++pass) {
    const double across = -dot(point, frame.v_across) / frame.v_squared;
    alpha += -dot(point, frame.u) / frame.u_squared - frame.shear * across;
    beta += across;
    if (kind == PairKind::kVf) {
      if (!(alpha >= 0 && beta >= 0 && alpha + beta <= 1)) return result;
      result.weights = {(1 - alpha) - beta, alpha, beta, 0};
    } else {
      if (!(alpha >= 0 && beta >= 0 && alpha <= 1 && beta <= 1)) return result;
      result.weights = {(1 - alpha) * (1 - beta), (1 - alpha) * beta, alpha * (1 - beta), alpha * beta};
    }
    if (!(result.weights[0] >= 0)) return result;
    point = weighted_sum(polygon, result.weights);
  }
  result.point = point;
  result.distance_squared = dot(point, point);
  result.direction = frame_normal(frame);
  if (dot(result.direction, polygon.corner[0]) < 0) result.direction = -result.direction;
  return result;
}

/// From one weight a corner to the weights of the four points.
std::array<double, 4> point_weights(PairKind kind, const Weights& w) {
  if (kind == PairKind::kEe) return {w[0] + w[1], w[2] + w[3], w[0] + w[2], w[1] + w[3]};
  return {1, w[0], w[1], w[2]};
}

}  // namespace

ClosestPoint closest_point(PairKind kind, const DifferencePolygon& polygon) {
  Candidate best = on_corner(polygon, 0);
  keep_nearer(best, on_corner(polygon, 1));
  if (kind != PairKind::kSelf) keep_nearer(best, on_corner(polygon, 2));
  if (kind == PairKind::kEe) {
    keep_nearer(best, on_corner(polygon, 3));
    keep_nearer(best, on_edge(polygon, {0, 1, &polygon.edge_v}));
    keep_nearer(best, on_edge(polygon, {2, 3, &polygon.edge_v}));
    keep_nearer(best, on_edge(polygon, {0, 2, &polygon.edge_u}));
    keep_nearer(best, on_edge(polygon, {1, 3, &polygon.edge_u}));
    keep_nearer(best, in_interior(kind, polygon));
  } else {
    keep_nearer(best, on_edge(polygon, {0, 1, &polygon.edge_u}));
    if (kind == PairKind::kVf) {
      keep_nearer(best, on_edge(polygon, {0, 2, &polygon.edge_v}));
      keep_nearer(best, on_edge(polygon, {1, 2, &polygon.edge_w}));
      keep_nearer(best, in_interior(kind, polygon));
    }
  }
  return {point_weights(kind, best.weights), best.point, normalize_exponent(best.direction)};
}

double distance_upper(PairKind kind, const DifferencePolygon& polygon, const Double3& blend_extent, bool exact_scaling,
                      const std::array<double, 4>& weights) {
  Weights w = {};
  bool zero = exact_scaling && is_zero(blend_extent);
  const auto uses = [&](std::size_t corner, double first, double second) {
    w[corner] = first * second;
    zero &= first == 0 || second == 0 || is_zero(polygon.corner[corner]);
  };
  if (kind == PairKind::kEe) {
    for (std::size_t i = 0; i < 4; ++i) uses(i, weights[i / 2], weights[2 + i % 2]);
  } else {
    for (std::size_t i = 0; i < 3; ++i) uses(i, weights[0], weights[i + 1]);
  }
  if (zero) return 0;
  const Double3 sum = weighted_sum(polygon, w);
  Double3 total;  // sum of w_i |x_i|
  double weight_total = 0;
  for (std::size_t i = 0; i < kMaxCorners; ++i) {
    total = total + w[i] * abs(polygon.corner[i]);
    weight_total += w[i];
  }
  const Double3 worst = (abs(sum) + kWitnessError * total) + kBlendError * blend_extent;
  // The exact weights are divided by their exact sum, so that they make a convex combination; its computed value is
  // good to 5 u. Quotient, norm, `worst` and this product round a few times more: 32 u covers all of them. 2^-1060:
  // products lost to underflow, a dozen of at most 2^-1074 an axis, and scaling.
  return norm(worst) / weight_total * (1 + 32 * kUnitRoundoff) + 0x1p-1060;
}

double support_error(const Double3& n, const Double3& extent) { return kSupportError * dot(abs(n), extent); }

double least_support(int corner_count, const DifferencePolygon& polygon, const Double3& n) {
  double least = std::min(dot(n, polygon.corner[0]), dot(n, polygon.corner[1]));
  for (int i = 2; i < corner_count; ++i) least = std::min(least, dot(n, polygon.corner[static_cast<std::size_t>(i)]));
  return least;
}

double distance_lower(int corner_count, const DifferencePolygon& polygon, const Double3& extent, const Double3& n) {
  const double support = least_support(corner_count, polygon, n) - support_error(n, extent);
  if (!(support > 0)) return 0;
  return support / norm(n) * (1 - 8 * kUnitRoundoff);
}

Double3 normalize_exponent(const Double3& v) {
  const double largest = max_component(abs(v));
  if (!(largest > 0) || largest == std::numeric_limits<double>::infinity()) return {};
  int shift = 0;
  double factor = 1;
  if (largest < std::numeric_limits<double>::min()) {
    factor = 0x1p+600;
    shift = 600;
  }
  const auto biased = static_cast<int>(std::bit_cast<std::uint64_t>(largest * factor) >> 52);
  const int exponent = biased - 1022 - shift;  // largest in [0.5, 1) * 2^exponent
  const int first = -exponent / 2;
  const int second = -exponent - first;
  const auto power = [](int e) { return std::bit_cast<double>(static_cast<std::uint64_t>(e + 1023) << 52); };
  return power(second) * (power(first) * v);
}

double norm(const Double3& v) {
  const double largest = max_component(abs(v));
  if (!(largest > 0)) return largest;  // 0 or NaN
  const Double3 scaled = normalize_exponent(v);
  const double squared = dot(scaled, scaled);
  const double length = std::sqrt(squared);
  const double ratio = largest / max_component(abs(scaled));  // the power of two, exact
  return length * ratio;
}

}  // namespace selvage::detail
