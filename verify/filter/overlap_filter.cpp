#include "verify/filter/overlap_filter.h"

#include <algorithm>
#include <cmath>

#include "verify/arithmetic/gaps.h"
#include "verify/arithmetic/predicates.h"

namespace selvage::verify {
namespace {

bool separates(const Point& u, const Local<3>& p, const Local<3>& q) {
  const auto [forward, backward] = gaps(u, p, q);
  return forward > 0 || backward > 0;
}

Point sum(const Local<3>& x) {
  Point total;
  for (std::size_t k = 0; k < 3; ++k) total[k] = x.points[0][k] + x.points[1][k] + x.points[2][k];
  return total;
}

double largest(const Point& v) { return std::max(std::max(std::abs(v[0]), std::abs(v[1])), std::abs(v[2])); }

/// Whether u . p > 0 > u . q for all points of two cones at the origin: then they meet there alone. By the bounds of
/// gaps().
bool opens_cones(const Point& u, const Local<2>& p, const Local<2>& q) {
  double magnitude = 0;
  for (std::size_t k = 0; k < 3; ++k) magnitude += std::abs(u[k]) * std::max(p.magnitude[k], q.magnitude[k]);
  const double margin = 0x1p-49 * magnitude + 0x1p-1070;
  return std::min(dot(u, p.points[0]), dot(u, p.points[1])) > margin &&
         std::max(dot(u, q.points[0]), dot(u, q.points[1])) < -margin;
}

/// A direction from the middle of q to the middle of p, both brought to about one size.
Point between_cones(const Local<2>& p, const Local<2>& q) {
  const double p_size = largest(p.magnitude), q_size = largest(q.magnitude);
  Point u;
  for (std::size_t k = 0; k < 3; ++k) {
    u[k] = q_size * (p.points[0][k] + p.points[1][k]) - p_size * (q.points[0][k] + q.points[1][k]);
  }
  return u;
}

}  // namespace

bool triage_apart(const std::array<Point, 3>& a, const std::array<Point, 3>& b) {
  const Local<3> p(b[0], a), q(b[0], b);
  if (separates(difference(sum(p), sum(q)), p, q)) return true;
  const std::array<Point, 3> edges_a = {difference(a[1], a[0]), difference(a[2], a[1]), difference(a[0], a[2])};
  const std::array<Point, 3> edges_b = {difference(b[1], b[0]), difference(b[2], b[1]), difference(b[0], b[2])};
  if (separates(cross(edges_a[0], edges_a[1]), p, q) || separates(cross(edges_b[0], edges_b[1]), p, q)) return true;
  for (const Point& e : edges_a) {
    for (const Point& f : edges_b) {
      if (separates(cross(e, f), p, q)) return true;
    }
  }
  return false;
}

bool triage_apart_beyond_vertex(const Point& s, const std::array<Point, 2>& p, const std::array<Point, 2>& q) {
  const Local<2> p_local(s, p), q_local(s, q);
  if (opens_cones(between_cones(p_local, q_local), p_local, q_local)) return true;
  // Two points strictly on one side of the other triangle's plane: that triangle lies in the plane, s is in both.
  const int q_side = triage_orient3d(s, p[0], p[1], q[0]);
  if (q_side != 0 && q_side == triage_orient3d(s, p[0], p[1], q[1])) return true;
  const int p_side = triage_orient3d(s, q[0], q[1], p[0]);
  return p_side != 0 && p_side == triage_orient3d(s, q[0], q[1], p[1]);
}

bool triage_apart_beyond_edge(const Point& a, const Point& b, const Point& c, const Point& d) {
  // They share more than the edge only when folded flat, and then their normals are parallel: equal signs throughout.
  for (int axis = 0; axis < 3; ++axis) {
    if (triage_normal(axis, a, b, c) * triage_normal(axis, a, b, d) < 0) return true;
  }
  return triage_orient3d(a, b, c, d) != 0;
}

}  // namespace selvage::verify
