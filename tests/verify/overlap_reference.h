// Two triangles at one instant by another road than the checker's: the intersection as a polygon, made by clipping one
// triangle with the half-spaces of the other in rational arithmetic. Slow and simple.
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include <gmpxx.h>

#include "verify/decision/exact_overlap.h"

namespace selvage::verify::reference {

using Rational = mpq_class;
using Vector = std::array<Rational, 3>;
using Polygon = std::vector<Vector>;  ///< convex, in one plane; points may repeat or be collinear

inline Vector exact(const Point& p) { return {Rational(p[0]), Rational(p[1]), Rational(p[2])}; }
inline std::array<Vector, 3> exact(const std::array<Point, 3>& t) { return {exact(t[0]), exact(t[1]), exact(t[2])}; }
inline Vector operator-(const Vector& a, const Vector& b) {
  return {Rational(a[0] - b[0]), Rational(a[1] - b[1]), Rational(a[2] - b[2])};
}
inline Vector operator+(const Vector& a, const Vector& b) {
  return {Rational(a[0] + b[0]), Rational(a[1] + b[1]), Rational(a[2] + b[2])};
}
inline Vector operator*(const Rational& s, const Vector& a) {
  return {Rational(s * a[0]), Rational(s * a[1]), Rational(s * a[2])};
}
inline Rational dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline Vector cross(const Vector& a, const Vector& b) {
  return {Rational(a[1] * b[2] - a[2] * b[1]), Rational(a[2] * b[0] - a[0] * b[2]),
          Rational(a[0] * b[1] - a[1] * b[0])};
}
inline bool is_zero(const Vector& a) { return a[0] == 0 && a[1] == 0 && a[2] == 0; }

/// normal . x >= offset.
struct HalfSpace {
  Vector normal;
  Rational offset;
  [[nodiscard]] int side(const Vector& x) const { return cmp(dot(normal, x), offset); }
};

inline Polygon clip(const Polygon& polygon, const HalfSpace& half_space) {
  Polygon kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
    const int side_p = half_space.side(p), side_q = half_space.side(q);
    if (side_p >= 0) kept.push_back(p);
    if (side_p * side_q < 0) {
      const Rational height_p = dot(half_space.normal, p) - half_space.offset;
      const Rational height_q = dot(half_space.normal, q) - half_space.offset;
      kept.push_back(p + Rational(height_p / (height_p - height_q)) * (q - p));
    }
  }
  return kept;
}

/// A triangle as the set of points that satisfy its half-spaces: first the equalities of its affine hull as pairs of
/// half-spaces, then its relative boundary.
struct Hull {
  int dimension = 0;
  std::vector<HalfSpace> equal, bound;
};

inline Hull hull(const std::array<Vector, 3>& t) {
  Hull h;
  const auto equality = [&](const Vector& normal, const Vector& through) {
    if (is_zero(normal)) return;
    h.equal.push_back({normal, dot(normal, through)});
    h.equal.push_back({Rational(-1) * normal, Rational(-dot(normal, through))});
  };
  const Vector n = cross(t[1] - t[0], t[2] - t[0]);
  if (!is_zero(n)) {
    h.dimension = 2;
    equality(n, t[0]);
    for (std::size_t i = 0; i < 3; ++i) {
      const Vector inward = cross(n, t[(i + 1) % 3] - t[i]);
      h.bound.push_back({inward, dot(inward, t[i])});
    }
    return h;
  }
  // A segment, or a point: the two corners farthest apart are its ends.
  std::size_t from = 0, to = 0;
  Rational longest = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector d = t[(i + 1) % 3] - t[i];
    if (dot(d, d) > longest) longest = dot(d, d), from = i, to = (i + 1) % 3;
  }
  const Vector d = t[to] - t[from];
  h.dimension = is_zero(d) ? 0 : 1;
  for (std::size_t k = 0; k < 3; ++k) {
    Vector axis{};
    axis[k] = 1;
    equality(h.dimension == 0 ? axis : cross(d, axis), t[from]);
  }
  if (h.dimension == 1) {
    h.bound.push_back({d, dot(d, t[from])});
    h.bound.push_back({Rational(-1) * d, Rational(-dot(d, t[to]))});
  }
  return h;
}

inline bool in_interior(const Hull& h, const Vector& x) {
  return std::all_of(h.equal.begin(), h.equal.end(), [&](const HalfSpace& s) { return s.side(x) == 0; }) &&
         std::all_of(h.bound.begin(), h.bound.end(), [&](const HalfSpace& s) { return s.side(x) > 0; });
}

inline bool on_segment(const Vector& x, const Vector& a, const Vector& b) {
  return is_zero(cross(b - a, x - a)) && dot(x - a, x - b) <= 0;
}

/// The points that two triangles have in common, as the corners of a convex polygon.
inline Polygon common_part(const std::array<Vector, 3>& p, const std::array<Vector, 3>& q) {
  const Hull hull_q = hull(q);
  Polygon common(p.begin(), p.end());
  for (const auto* half_spaces : {&hull_q.equal, &hull_q.bound}) {
    for (const HalfSpace& half_space : *half_spaces) common = clip(common, half_space);
  }
  return common;
}

/// -1 empty, 0 a point, 1 a segment, 2 an area.
inline int dimension(const Polygon& polygon) {
  if (polygon.empty()) return -1;
  Vector along{};
  for (const Vector& x : polygon) {
    if (is_zero(along)) along = x - polygon[0];
    if (!is_zero(cross(along, x - polygon[0]))) return 2;
  }
  return is_zero(along) ? 0 : 1;
}

inline OverlapKind overlap(const std::array<std::int32_t, 3>& face_a, const std::array<Point, 3>& a,
                           const std::array<std::int32_t, 3>& face_b, const std::array<Point, 3>& b) {
  const std::array<Vector, 3> p = exact(a), q = exact(b);
  std::vector<Vector> shared;
  for (std::size_t i = 0; i < 3; ++i) {
    if (std::find(face_b.begin(), face_b.end(), face_a[i]) != face_b.end()) shared.push_back(p[i]);
  }
  if (shared.size() == 3) return OverlapKind::kSame;

  const Hull hull_p = hull(p), hull_q = hull(q);
  const Polygon common = common_part(p, q);
  const bool beyond = std::any_of(common.begin(), common.end(), [&](const Vector& x) {
    if (shared.empty()) return true;
    return !on_segment(x, shared.front(), shared.back());  // of length zero where only a vertex is shared
  });
  if (!beyond) return OverlapKind::kNone;

  // The centroid of the corners lies in the relative interior of the common polygon, so in those of both triangles if
  // these meet at all.
  Vector center{};
  for (const Vector& x : common) center = center + Rational(1, static_cast<unsigned long>(common.size())) * x;
  const bool interiors_meet = in_interior(hull_p, center) && in_interior(hull_q, center);
  bool parallel = true;  // the direction or normal of each is that of one plane
  if (hull_p.dimension == 2 && hull_q.dimension == 2) {
    parallel = is_zero(cross(hull_p.equal[0].normal, hull_q.equal[0].normal));
  } else if (hull_p.dimension == 2 && hull_q.dimension == 1) {
    parallel = dot(hull_p.equal[0].normal, hull_q.bound[0].normal) == 0;
  } else if (hull_p.dimension == 1 && hull_q.dimension == 2) {
    parallel = dot(hull_q.equal[0].normal, hull_p.bound[0].normal) == 0;
  }
  if (!interiors_meet) return OverlapKind::kTouch;
  if (!parallel) return OverlapKind::kPierce;
  if (hull_p.dimension < 2 || hull_q.dimension < 2) return OverlapKind::kTouch;
  return shared.size() == 2 ? OverlapKind::kFold : OverlapKind::kCoplanar;
}

}  // namespace selvage::verify::reference
