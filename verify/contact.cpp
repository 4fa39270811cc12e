#include "verify/contact.h"

#include <array>
#include <utility>
#include <vector>

namespace selvage::verify {
namespace {

// Legend. n: normal of the triangle, or of the plane of both edges; f: the coplanarity cubic, n . (a difference between
// the features); c: lambda n for every weight lambda (barycentric; or along each edge, and one minus that).
// g, h: the point p is on the closed segment (x, y) iff g = (p-x) x (p-y) = 0 and h = (p-x) . (p-y) <= 0, also where x
// = y.

struct OnSegment {
  FormVector g;
  Form h;
};

OnSegment on_segment(const MovingPoint& p, const MovingPoint& x, const MovingPoint& y) {
  const FormVector from_x = p - x, from_y = p - y;
  return {cross(from_x, from_y), dot(from_x, from_y)};
}

bool holds(const OnSegment& condition, Instant& instant) {
  for (const Form& component : condition.g) {
    if (instant.sign_of(component) != 0) return false;
  }
  return instant.sign_of(condition.h) <= 0;
}

/// The first time inside (0,1) at which the point is on the segment. REQUIRES that it is not at t = 0.
std::optional<Instant> first_time_inside(const OnSegment& condition) {
  // Where g vanishes identically, h(0) > 0 (not on the segment at t = 0) and h is continuous, so it is first <= 0 at a
  // root.
  const Form* candidates = &condition.h;
  for (const Form& component : condition.g) {
    if (!component.is_zero()) candidates = &component;
  }
  for (Instant& root : roots_inside(*candidates)) {
    if (holds(condition, root)) return std::move(root);
  }
  return std::nullopt;
}

/// One vertex-face or edge-edge pair.
struct Pair {
  FormVector n;
  Form f;
  std::vector<FormVector> c;
  std::vector<OnSegment> boundary;  ///< features with n = 0 meet iff one of these holds
};

struct Contact {
  bool touches = false;
  bool is_interior = false;  ///< n is not 0, and all weights are positive
};

/// REQUIRES f = 0 at the instant.
Contact contact_at(const Pair& pair, Instant& instant) {
  for (std::size_t k = 0; k < 3; ++k) {
    const int orientation = instant.sign_of(pair.n[k]);
    if (orientation == 0) continue;
    // Projection along axis k is one-to-one on the plane of contact, where c_k = lambda n_k.
    Contact contact{true, true};
    for (const FormVector& c : pair.c) {
      const int sign = instant.sign_of(c[k]);
      if (sign == -orientation) return {};
      if (sign == 0) contact.is_interior = false;
    }
    return contact;
  }
  for (const OnSegment& condition : pair.boundary) {
    if (holds(condition, instant)) return {true, false};
  }
  return {};
}

/// The first time inside (0,1) at which a condition holds. REQUIRES that none does at t = 0.
std::optional<Instant> first_time_inside(std::span<const OnSegment> conditions) {
  std::optional<Instant> first;
  for (const OnSegment& condition : conditions) {
    std::optional<Instant> instant = first_time_inside(condition);
    if (instant && (!first || compare(*instant, *first) < 0)) first = std::move(instant);
  }
  return first;
}

std::optional<FirstTouch> first_touch(const Pair& pair) {
  Instant start = Instant::start(), end = Instant::end();
  if (start.sign_of(pair.f) == 0 && contact_at(pair, start).touches) return FirstTouch{start, false};
  if (pair.f.is_zero()) {
    // Coplanar throughout: a contact that begins inside (0,1) begins at the boundary of a feature, or where n = 0.
    if (auto instant = first_time_inside(pair.boundary)) return FirstTouch{std::move(*instant), false};
  } else {
    for (Instant& root : roots_inside(pair.f)) {
      const Contact contact = contact_at(pair, root);
      if (contact.touches) {
        const bool is_cross = contact.is_interior && root.is_odd_root_of(pair.f);
        return FirstTouch{std::move(root), is_cross};
      }
    }
  }
  if (end.sign_of(pair.f) == 0 && contact_at(pair, end).touches) return FirstTouch{end, false};
  return std::nullopt;
}

}  // namespace

std::optional<FirstTouch> first_vf_touch(std::span<const MovingPoint, 4> x) {
  const MovingPoint &q = x[0], &v0 = x[1], &v1 = x[2], &v2 = x[3];
  const FormVector e1 = v1 - v0, e2 = v2 - v0, r = q - v0;
  Pair pair;
  pair.n = cross(e1, e2);
  pair.f = dot(pair.n, r);
  if (pair.f.is_definite()) return std::nullopt;
  const FormVector c2 = cross(e1, r), c1 = cross(r, e2);
  pair.c = {pair.n - c1 - c2, c1, c2};
  pair.boundary = {on_segment(q, v0, v1), on_segment(q, v0, v2), on_segment(q, v1, v2)};
  return first_touch(pair);
}

std::optional<FirstTouch> first_ee_touch(std::span<const MovingPoint, 4> x) {
  const MovingPoint &a0 = x[0], &a1 = x[1], &b0 = x[2], &b1 = x[3];
  const FormVector u = a1 - a0, v = b1 - b0, w = b0 - a0;
  Pair pair;
  pair.n = cross(u, v);
  pair.f = dot(pair.n, w);
  if (pair.f.is_definite()) return std::nullopt;
  const FormVector along_a = cross(w, v), along_b = cross(w, u);
  pair.c = {along_a, pair.n - along_a, along_b, pair.n - along_b};
  pair.boundary = {on_segment(a0, b0, b1), on_segment(a1, b0, b1), on_segment(b0, a0, a1), on_segment(b1, a0, a1)};
  return first_touch(pair);
}

std::optional<FirstTouch> first_self_touch(std::span<const MovingPoint, 3> x) {
  const OnSegment condition = on_segment(x[0], x[1], x[2]);
  Instant start = Instant::start(), end = Instant::end();
  if (holds(condition, start)) return FirstTouch{start, false};
  if (auto instant = first_time_inside(condition)) return FirstTouch{std::move(*instant), false};
  if (holds(condition, end)) return FirstTouch{end, false};
  return std::nullopt;
}

}  // namespace selvage::verify
