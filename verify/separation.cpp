#include "verify/separation.h"

#include <cmath>
#include <span>

#include "verify/direction.h"
#include "verify/predicates.h"

namespace selvage::verify {
namespace {

Point sum(std::span<const Point> vectors) {
  Point total{};
  for (const Point& v : vectors) {
    for (std::size_t k = 0; k < 3; ++k) total[k] += v[k];
  }
  return total;
}

/// Length about one: only a guess at a direction, so its rounding does not matter.
Point normalized(const Point& v) {
  const double length = std::sqrt(dot(v, v));
  return {v[0] / length, v[1] / length, v[2] / length};
}

template <std::size_t N, std::size_t M>
bool separates(const Point& u, const Local<N>& p, const Local<M>& q) {
  return gap_lower(u, p, q) > 0;
}

template <std::size_t N, std::size_t M>
bool separates_either_way(const Point& u, const Local<N>& p, const Local<M>& q) {
  return separates(u, p, q) || separates(u, q, p);
}

}  // namespace

bool triage_apart(const std::array<Point, 3>& a, const std::array<Point, 3>& b) {
  const Local<3> p(b[0], a), q(b[0], b);
  const std::array<Point, 3> edges_a = {difference(a[1], a[0]), difference(a[2], a[1]), difference(a[0], a[2])};
  const std::array<Point, 3> edges_b = {difference(b[1], b[0]), difference(b[2], b[1]), difference(b[0], b[2])};
  if (separates_either_way(cross(edges_a[0], edges_a[1]), p, q)) return true;
  if (separates_either_way(cross(edges_b[0], edges_b[1]), p, q)) return true;
  if (separates(difference(sum(p.points), sum(q.points)), p, q)) return true;
  for (const Point& e : edges_a) {
    for (const Point& f : edges_b) {
      if (separates_either_way(cross(e, f), p, q)) return true;
    }
  }
  return false;
}

bool triage_apart_beyond_vertex(const Point& s, const std::array<Point, 2>& p, const std::array<Point, 2>& q) {
  // Two points strictly on one side of the other triangle's plane: that triangle lies in the plane, s is in both.
  const int q_side = triage_orient3d(s, p[0], p[1], q[0]);
  if (q_side != 0 && q_side == triage_orient3d(s, p[0], p[1], q[1])) return true;
  const int p_side = triage_orient3d(s, q[0], q[1], p[0]);
  if (p_side != 0 && p_side == triage_orient3d(s, q[0], q[1], p[1])) return true;
  // u . p > 0 > u . q strictly separates the two cones at s; `zero` is s itself.
  const Local<2> p_local(s, p), q_local(s, q);
  const Local<1> zero(s, {s});
  const auto opens = [&](const Point& u) { return separates(u, p_local, zero) && separates(u, zero, q_local); };
  const Point p_middle = normalized(sum(p_local.points)), q_middle = normalized(sum(q_local.points));
  if (opens(difference(p_middle, q_middle))) return true;
  return opens(p_middle) || opens({-q_middle[0], -q_middle[1], -q_middle[2]});
}

bool triage_apart_beyond_edge(const Point& a, const Point& b, const Point& c, const Point& d) {
  // They share more than the edge only when folded flat, and then their normals are parallel: equal signs throughout.
  for (int axis = 0; axis < 3; ++axis) {
    if (triage_normal(axis, a, b, c) * triage_normal(axis, a, b, d) < 0) return true;
  }
  return triage_orient3d(a, b, c, d) != 0;
}

}  // namespace selvage::verify
