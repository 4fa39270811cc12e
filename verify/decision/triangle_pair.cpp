#include "verify/decision/triangle_pair.h"

#include <algorithm>
#include <array>

namespace selvage::verify {
namespace {

bool no_opposite_signs(int u, int v, int w) { return std::min({u, v, w}) * std::max({u, v, w}) >= 0; }

/// A corner strictly on one side of a plane whose other two corners are not: the two edges from it cross the plane, at
/// `first` and `last` along the common line of the planes.
struct Crossing {
  int apex = -1, first = -1, last = -1;
  int apex_side = 0;
};

/// REQUIRES sides of both signs. `direction`: 1 if the crossing of (apex, next corner) comes last for a positive apex.
Crossing find_crossing(const std::array<int, 3>& corners, const std::array<int, 3>& sides, int direction) {
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t next = (i + 1) % 3, previous = (i + 2) % 3;
    if (sides[i] == 0 || sides[next] == sides[i] || sides[previous] == sides[i]) continue;
    const bool next_is_last = sides[i] * direction > 0;
    return {corners[i], corners[next_is_last ? previous : next], corners[next_is_last ? next : previous], sides[i]};
  }
  return {};
}

bool has_both_signs(const std::array<int, 3>& sides) {
  return std::min({sides[0], sides[1], sides[2]}) < 0 && std::max({sides[0], sides[1], sides[2]}) > 0;
}

}  // namespace

bool TrianglePair::on_segment(int p, int x, int y) {
  for (int k = 0; k < 3; ++k) {
    if (signs_.compare(k, p, x) * signs_.compare(k, p, y) > 0) return false;
  }
  return signs_.projection_axis(x, y, p) < 0;
}

bool TrianglePair::segments_meet(int p, int q, int x, int y) {
  if (on_segment(p, x, y) || on_segment(q, x, y) || on_segment(x, p, q) || on_segment(y, p, q)) return true;
  // Otherwise they can only cross in their interiors; then p, q, x span the plane that all four points lie in.
  if (signs_.orient3d(p, q, x, y) != 0) return false;
  const int k = signs_.projection_axis(p, q, x);
  return k >= 0 && signs_.normal(k, p, q, x) * signs_.normal(k, p, q, y) < 0 &&
         signs_.normal(k, x, y, p) * signs_.normal(k, x, y, q) < 0;
}

/// REQUIRES p in the plane of t, t not flat.
bool TrianglePair::in_triangle(int p, const Corners& t) {
  return no_opposite_signs(signs_.normal(t.axis, t.a, t.b, p), signs_.normal(t.axis, t.b, t.c, p),
                           signs_.normal(t.axis, t.c, t.a, p));
}

bool TrianglePair::on_triangle(int p, const Corners& t) {
  if (t.flat()) return on_segment(p, t.a, t.b) || on_segment(p, t.b, t.c) || on_segment(p, t.c, t.a);
  return side(t, p) == 0 && in_triangle(p, t);
}

bool TrianglePair::segment_meets_triangle(int p, int q, const Corners& t) {
  const auto meets_an_edge = [&] {
    return segments_meet(p, q, t.a, t.b) || segments_meet(p, q, t.b, t.c) || segments_meet(p, q, t.c, t.a);
  };
  if (t.flat()) return meets_an_edge();
  const int side_p = side(t, p), side_q = side(t, q);
  if (side_p * side_q > 0) return false;
  if (side_p == 0 && side_q == 0) return in_triangle(p, t) || in_triangle(q, t) || meets_an_edge();
  return no_opposite_signs(signs_.orient3d(p, q, t.a, t.b), signs_.orient3d(p, q, t.b, t.c),
                           signs_.orient3d(p, q, t.c, t.a));
}

bool TrianglePair::edges_meet_triangle(const Corners& t, const Corners& u) {
  return segment_meets_triangle(t.a, t.b, u) || segment_meets_triangle(t.b, t.c, u) ||
         segment_meets_triangle(t.c, t.a, u);
}

bool TrianglePair::meet(const Corners& t, const Corners& u) {
  return edges_meet_triangle(t, u) || edges_meet_triangle(u, t);
}

bool TrianglePair::meet_beyond_vertex(const Corners& t, const Corners& u) {
  // Towards a common point the ray from s leaves one of the triangles first, through the edge opposite s: both are
  // convex, so that point of the edge is in the other triangle too. A flat triangle is its two edges at s.
  if (t.flat()) return spoke_meets(t.a, t.b, u) || spoke_meets(t.a, t.c, u);
  if (u.flat()) return spoke_meets(u.a, u.b, t) || spoke_meets(u.a, u.c, t);
  return segment_meets_triangle(t.b, t.c, u) || segment_meets_triangle(u.b, u.c, t);
}

/// Whether the segment from s = u.a to p meets u in a point other than s: by the same argument at p or at the edge
/// opposite s.
bool TrianglePair::spoke_meets(int s, int p, const Corners& u) {
  if (signs_.equal(s, p)) return false;
  if (u.flat()) return same_direction(s, p, u.b) || same_direction(s, p, u.c);
  return on_triangle(p, u) || segments_meet(s, p, u.b, u.c);
}

/// p and q lie on one ray from s, neither at s.
bool TrianglePair::same_direction(int s, int p, int q) {
  if (signs_.equal(s, p) || signs_.equal(s, q) || signs_.projection_axis(s, p, q) >= 0) return false;
  for (int k = 0; k < 3; ++k) {
    if (const int way = signs_.compare(k, p, s); way != 0) return way == signs_.compare(k, q, s);
  }
  return false;
}

bool TrianglePair::meet_beyond_edge(const Corners& t, const Corners& u) {
  if (t.flat() != u.flat()) return false;  // the flat one lies in the line of the edge, where the other is the edge
  if (!t.flat()) {
    return side(t, u.c) == 0 && signs_.normal(t.axis, t.a, t.b, t.c) == signs_.normal(t.axis, t.a, t.b, u.c);
  }
  // All on one line: they share more than the edge only where both stick out of it at the same end.
  if (signs_.equal(t.a, t.b)) return same_direction(t.a, t.c, u.c);
  const auto sticks_out = [&](int a, int b, int c) { return !signs_.equal(b, c) && on_segment(b, a, c); };
  return (sticks_out(t.a, t.b, t.c) && sticks_out(t.a, t.b, u.c)) ||
         (sticks_out(t.b, t.a, t.c) && sticks_out(t.b, t.a, u.c));
}

/// Whether the line (p, q) has u on one closed side and `inner` on the other, all in one plane.
bool TrianglePair::edge_separates(int p, int q, int inner, const Corners& u, int axis) {
  const int inside = signs_.normal(axis, p, q, inner);
  return inside * signs_.normal(axis, p, q, u.a) <= 0 && inside * signs_.normal(axis, p, q, u.b) <= 0 &&
         inside * signs_.normal(axis, p, q, u.c) <= 0;
}

bool TrianglePair::share_area(const Corners& t, const Corners& u) {
  if (side(t, u.a) != 0 || side(t, u.b) != 0 || side(t, u.c) != 0) return false;
  // Convex regions of a plane have no common region iff the line of an edge separates them.
  const auto separated_by_edge_of = [&](const Corners& x, const Corners& y) {
    return edge_separates(x.a, x.b, x.c, y, t.axis) || edge_separates(x.b, x.c, x.a, y, t.axis) ||
           edge_separates(x.c, x.a, x.b, y, t.axis);
  };
  return !separated_by_edge_of(t, u) && !separated_by_edge_of(u, t);
}

bool TrianglePair::segment_pierces(int p, int q, const Corners& t) {
  if (side(t, p) * side(t, q) >= 0) return false;
  const int u = signs_.orient3d(p, q, t.a, t.b);
  return u != 0 && u == signs_.orient3d(p, q, t.b, t.c) && u == signs_.orient3d(p, q, t.c, t.a);
}

bool TrianglePair::pierce(const Corners& t, const Corners& u) {
  if (t.flat() && u.flat()) return false;
  if (t.flat()) {
    return segment_pierces(t.a, t.b, u) || segment_pierces(t.b, t.c, u) || segment_pierces(t.c, t.a, u);
  }
  if (u.flat()) return pierce(u, t);
  const std::array<int, 3> sides_t = {side(u, t.a), side(u, t.b), side(u, t.c)};
  const std::array<int, 3> sides_u = {side(t, u.a), side(t, u.b), side(t, u.c)};
  if (!has_both_signs(sides_t) || !has_both_signs(sides_u)) return false;
  // Each triangle cuts the common line of the two planes in a segment; the interiors meet iff these overlap in more
  // than a point. Along n_t x n_u, crossing x of an edge (p, q) of t comes before crossing y of (r, s) of u iff
  // orient3d(p, q, r, s) has the sign of the product of the sides of the apexes p and r.
  const Crossing x = find_crossing({t.a, t.b, t.c}, sides_t, 1), y = find_crossing({u.a, u.b, u.c}, sides_u, -1);
  const int sign = x.apex_side * y.apex_side;
  return sign * signs_.orient3d(x.apex, x.first, y.apex, y.last) > 0 &&
         sign * signs_.orient3d(x.apex, x.last, y.apex, y.first) < 0;
}

}  // namespace selvage::verify
