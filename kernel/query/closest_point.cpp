#include "kernel/query/closest_point.h"

#include "kernel/arithmetic/power_of_two.h"

namespace selvage::detail {

namespace {

enum class Feature : std::uint8_t { kCorner, kEdge, kInterior };

template <class Real>
struct Nearest {
  double distance_squared = std::numeric_limits<double>::infinity();
  Triple<Real> point;
  std::array<Real, 4> corner_weights = {};
  Feature feature = Feature::kCorner;
  const Triple<Real>* edge = nullptr;
};

/// Two edges from one corner that span the polygon's plane, the shorter one first: v_across = v - shear u is orthogonal
/// to u, to rounding even where the edges are nearly parallel (orthogonalised twice; Kahan: twice is enough).
template <class Real>
struct PlaneFrame {
  std::array<std::uint8_t, 4> corner;  // at the base, at the end of u, at the end of v, opposite (ee)
  Triple<Real> u, v_across;
  Real u_squared{}, v_squared{}, shear{};
  bool valid = false;
};

/// At the corner nearest to the origin, where the differences are smallest and so are their errors.
template <class Real>
PlaneFrame<Real> make_frame(PairKind kind, const DifferencePolygon<Real>& polygon, std::size_t base) {
  const Triple<Real>&u = polygon.edge_u, &v = polygon.edge_v, &w = polygon.edge_w;
  PlaneFrame<Real> frame;
  if (kind == PairKind::kEe) {
    frame.corner = {static_cast<std::uint8_t>(base), static_cast<std::uint8_t>(base ^ 2U),
                    static_cast<std::uint8_t>(base ^ 1U), static_cast<std::uint8_t>(base ^ 3U)};
    frame.u = (base & 2U) == 0 ? u : -u;
    frame.v_across = (base & 1U) == 0 ? v : -v;
  } else if (base == 0) {
    frame = {{0, 1, 2, 3}, u, v};
  } else if (base == 1) {
    frame = {{1, 0, 2, 3}, -u, w};
  } else {
    frame = {{2, 0, 1, 3}, -v, -w};
  }
  frame.u_squared = dot(frame.u, frame.u);
  const Real other_squared = dot(frame.v_across, frame.v_across);
  if (other_squared < frame.u_squared) {
    std::swap(frame.u, frame.v_across);
    std::swap(frame.corner[1], frame.corner[2]);
    frame.u_squared = other_squared;
  }
  if (!(leading(frame.u_squared) > 0)) return frame;
  for (int pass = 0; pass < 2; ++pass) {
    const Real k = dot(frame.u, frame.v_across) / frame.u_squared;
    frame.v_across = frame.v_across - scaled(k, frame.u);
    frame.shear = frame.shear + k;
  }
  frame.v_squared = dot(frame.v_across, frame.v_across);
  frame.valid = leading(frame.v_squared) > 0;
  return frame;
}

template <class Real>
Triple<Real> orthogonalised(const Triple<Real>& n, const Triple<Real>& edge, const Real& edge_squared) {
  return n - scaled(Real(dot(n, edge) / edge_squared), edge);
}

/// Orthogonal to both edges, relative to their lengths, even where the cross product has cancelled.
template <class Real>
Triple<Real> frame_normal(const PlaneFrame<Real>& frame) {
  Triple<Real> n = normalize_exponent(cross(frame.u, frame.v_across));
  for (int pass = 0; pass < 2; ++pass) {
    n = orthogonalised(n, frame.u, frame.u_squared);
    n = orthogonalised(n, frame.v_across, frame.v_squared);
  }
  return n;
}

template <class Real>
Triple<Real> weighted_sum(const DifferencePolygon<Real>& polygon, const std::array<Real, 4>& w) {
  const auto& c = polygon.corner;
  return (scaled(w[0], c[0]) + scaled(w[1], c[1])) + (scaled(w[2], c[2]) + scaled(w[3], c[3]));
}

/// Within rounding the feature of higher dimension is taken: exactly its point is nearer, and its direction is
/// orthogonal to more of the polygon.
constexpr double kTie = 1 + 0x1p-50;

template <class Real>
bool consider_corner(Nearest<Real>& nearest, const DifferencePolygon<Real>& polygon, std::size_t corner) {
  const double distance_squared = leading(dot(polygon.corner[corner], polygon.corner[corner]));
  if (!(distance_squared < nearest.distance_squared)) return false;
  nearest = {distance_squared, polygon.corner[corner], {}, Feature::kCorner, nullptr};
  nearest.corner_weights[corner] = Real(1);
  return true;
}

/// The foot of the perpendicular, where it lies within the edge, seen from its nearer end.
template <class Real>
void consider_edge(Nearest<Real>& nearest, const DifferencePolygon<Real>& polygon, std::size_t first,
                   std::size_t second, const Triple<Real>& edge) {
  const Real length_squared = dot(edge, edge);
  const Real from_first = -dot(polygon.corner[first], edge), from_second = dot(polygon.corner[second], edge);
  if (!(leading(from_first) > 0 && leading(from_second) > 0)) return;
  const bool near_first = from_first < from_second;
  const Real t = (near_first ? from_first : from_second) / length_squared;
  const Real rest = Real(1) - t;
  if (!(leading(rest) >= 0)) return;  // the edge is shorter than the rounding of its ends, which disagree with it
  const Triple<Real> foot =
      near_first ? polygon.corner[first] + scaled(t, edge) : polygon.corner[second] - scaled(t, edge);
  const double distance_squared = leading(dot(foot, foot));
  if (!(distance_squared < kTie * nearest.distance_squared)) return;
  nearest = {distance_squared, foot, {}, Feature::kEdge, &edge};
  nearest.corner_weights[first] = near_first ? rest : t;
  nearest.corner_weights[second] = near_first ? t : rest;
}

/// Steps of the least-squares problem min |base + alpha u + beta v|. The residual is recomputed from the corners, so
/// each step shrinks the error by the condition of the frame times the roundoff.
template <class Real>
void consider_interior(Nearest<Real>& nearest, PairKind kind, const DifferencePolygon<Real>& polygon,
                       const PlaneFrame<Real>& frame) {
  Real alpha{}, beta{};
  Triple<Real> point = polygon.corner[frame.corner[0]];
  std::array<Real, 4> weights = {};
  for (int step = 0; step < 3; ++step) {
    const Real across = -dot(point, frame.v_across) / frame.v_squared;
    alpha = alpha + (-dot(point, frame.u) / frame.u_squared - frame.shear * across);
    beta = beta + across;
    const Real alpha_rest = Real(1) - alpha, beta_rest = Real(1) - beta;
    if (!(leading(alpha) >= 0 && leading(beta) >= 0)) return;
    if (kind == PairKind::kVf) {
      if (!(leading(alpha_rest - beta) >= 0)) return;
      weights[frame.corner[0]] = alpha_rest - beta;
      weights[frame.corner[1]] = alpha;
      weights[frame.corner[2]] = beta;
    } else {
      if (!(leading(alpha_rest) >= 0 && leading(beta_rest) >= 0)) return;
      weights[frame.corner[0]] = alpha_rest * beta_rest;
      weights[frame.corner[1]] = alpha * beta_rest;
      weights[frame.corner[2]] = alpha_rest * beta;
      weights[frame.corner[3]] = alpha * beta;
    }
    point = weighted_sum(polygon, weights);
  }
  const double distance_squared = leading(dot(point, point));
  if (distance_squared < kTie * nearest.distance_squared) {
    nearest = {distance_squared, point, weights, Feature::kInterior, nullptr};
  }
}

template <class Real>
std::array<double, 4> point_weights(PairKind kind, const std::array<Real, 4>& w) {
  if (kind == PairKind::kEe) {
    return {leading(w[0] + w[1]), leading(w[2] + w[3]), leading(w[0] + w[2]), leading(w[1] + w[3])};
  }
  return {1, leading(w[0]), leading(w[1]), leading(w[2])};
}

}  // namespace

template <class Real>
ClosestPoint<Real> closest_point(PairKind kind, const DifferencePolygon<Real>& polygon) {
  Nearest<Real> nearest;
  PlaneFrame<Real> frame;
  std::size_t base = 0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(corner_count(kind)); ++i) {
    if (consider_corner(nearest, polygon, i)) base = i;
  }
  if (kind == PairKind::kEe) {
    consider_edge(nearest, polygon, 0, 1, polygon.edge_v);
    consider_edge(nearest, polygon, 2, 3, polygon.edge_v);
    consider_edge(nearest, polygon, 0, 2, polygon.edge_u);
    consider_edge(nearest, polygon, 1, 3, polygon.edge_u);
  } else {
    consider_edge(nearest, polygon, 0, 1, polygon.edge_u);
  }
  if (kind == PairKind::kVf) {
    consider_edge(nearest, polygon, 0, 2, polygon.edge_v);
    consider_edge(nearest, polygon, 1, 2, polygon.edge_w);
  }
  if (kind != PairKind::kSelf) {
    frame = make_frame(kind, polygon, base);
    if (frame.valid) consider_interior(nearest, kind, polygon, frame);
  }

  ClosestPoint<Real> result{point_weights(kind, nearest.corner_weights), nearest.point, nearest.point, {}};
  if (frame.valid) {
    result.plane_normal = normalize_exponent(frame_normal(frame));
    if (leading(dot(result.plane_normal, polygon.corner[base])) < 0) result.plane_normal = -result.plane_normal;
  }
  if (nearest.feature == Feature::kEdge) {
    result.direction = orthogonalised(nearest.point, *nearest.edge, Real(dot(*nearest.edge, *nearest.edge)));
  } else if (nearest.feature == Feature::kInterior) {
    result.direction = result.plane_normal;
  }
  result.direction = normalize_exponent(result.direction);
  return result;
}

template ClosestPoint<double> closest_point(PairKind, const DifferencePolygon<double>&);
template ClosestPoint<DoubleDouble> closest_point(PairKind, const DifferencePolygon<DoubleDouble>&);

std::array<double, 4> corner_weights(PairKind kind, const std::array<double, 4>& w) {
  if (kind == PairKind::kEe) return {w[0] * w[2], w[0] * w[3], w[1] * w[2], w[1] * w[3]};
  return {w[1], w[2], w[3], 0};
}

}  // namespace selvage::detail
