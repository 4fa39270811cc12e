#include "verify/decision/contact.h"

#include <array>
#include <cstddef>
#include <utility>

namespace selvage::verify {
namespace {

// Legend. n: normal of the triangle, or of the plane of both edges; f: the coplanarity cubic, n . (a difference between
// the features); lambda: the weights of a point of contact (barycentric; or along each edge, and one minus that).
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

/// The point `point` and the segment from `from` to `to`, by their places in a pair.
struct BoundaryCase {
  std::size_t point, from, to;
};

/// Point x[0] and triangle x[1], x[2], x[3]: x[0] = x[1] + alpha e1 + beta e2 in their plane.
struct VfPair {
  static constexpr std::array<BoundaryCase, 3> kBoundary = {{{0, 1, 2}, {0, 1, 3}, {0, 2, 3}}};

  explicit VfPair(std::span<const MovingPoint, 4> points)
      : x(points), e1(x[2] - x[1]), e2(x[3] - x[1]), r(x[0] - x[1]), n(cross(e1, e2)), f(dot(n, r)) {}

  /// lambda n_k for every weight lambda.
  [[nodiscard]] std::array<Form, 3> weights(std::size_t k) const {
    Form beta = cross_component(e1, r, k), alpha = cross_component(r, e2, k);
    Form rest = n[k] - alpha - beta;
    return {std::move(rest), std::move(alpha), std::move(beta)};
  }

  std::span<const MovingPoint, 4> x;
  FormVector e1, e2, r, n;
  Form f;
};

/// Edges (x[0], x[1]) and (x[2], x[3]): x[0] + alpha u = x[2] + beta v in their plane.
struct EePair {
  static constexpr std::array<BoundaryCase, 4> kBoundary = {{{0, 2, 3}, {1, 2, 3}, {2, 0, 1}, {3, 0, 1}}};

  explicit EePair(std::span<const MovingPoint, 4> points)
      : x(points), u(x[1] - x[0]), v(x[3] - x[2]), w(x[2] - x[0]), n(cross(u, v)), f(dot(n, w)) {}

  /// lambda n_k for lambda = alpha, 1 - alpha, beta, 1 - beta.
  [[nodiscard]] std::array<Form, 4> weights(std::size_t k) const {
    Form alpha = cross_component(w, v, k), beta = cross_component(w, u, k);
    Form alpha_rest = n[k] - alpha, beta_rest = n[k] - beta;
    return {std::move(alpha), std::move(alpha_rest), std::move(beta), std::move(beta_rest)};
  }

  std::span<const MovingPoint, 4> x;
  FormVector u, v, w, n;
  Form f;
};

template <class Pair>
OnSegment on_boundary(const Pair& pair, const BoundaryCase& boundary) {
  return on_segment(pair.x[boundary.point], pair.x[boundary.from], pair.x[boundary.to]);
}

struct Contact {
  bool touches = false;
  bool is_interior = false;  ///< n is not 0, and all weights are positive
};

/// REQUIRES f = 0 at the instant.
template <class Pair>
Contact contact_at(const Pair& pair, Instant& instant) {
  for (std::size_t k = 0; k < 3; ++k) {
    const int orientation = instant.sign_of(pair.n[k]);
    if (orientation == 0) continue;
    // Projection along axis k is one-to-one on the plane of contact, where the weights have the sign of lambda.
    Contact contact{true, true};
    for (const Form& weight : pair.weights(k)) {
      const int sign = instant.sign_of(weight);
      if (sign == -orientation) return {};
      if (sign == 0) contact.is_interior = false;
    }
    return contact;
  }
  // n = 0: the features meet iff a point of one's boundary is on a boundary segment of the other.
  for (const BoundaryCase& boundary : Pair::kBoundary) {
    if (holds(on_boundary(pair, boundary), instant)) return {true, false};
  }
  return {};
}

/// The first time inside (0,1) at which a point is on a boundary segment. REQUIRES that none is at t = 0.
template <class Pair>
std::optional<Instant> first_boundary_time_inside(const Pair& pair) {
  std::optional<Instant> first;
  for (const BoundaryCase& boundary : Pair::kBoundary) {
    std::optional<Instant> instant = first_time_inside(on_boundary(pair, boundary));
    if (instant && (!first || compare(*instant, *first) < 0)) first = std::move(instant);
  }
  return first;
}

template <class Pair>
std::optional<FirstTouch> first_touch(const Pair& pair) {
  if (pair.f.is_definite()) return std::nullopt;
  Instant start = Instant::start(), end = Instant::end();
  if (start.sign_of(pair.f) == 0 && contact_at(pair, start).touches) return FirstTouch{start, false};
  if (pair.f.is_zero()) {
    // Coplanar throughout: a contact that begins inside (0,1) begins at the boundary of a feature, or where n = 0.
    if (auto instant = first_boundary_time_inside(pair)) return FirstTouch{std::move(*instant), false};
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

std::optional<FirstTouch> first_vf_touch(std::span<const MovingPoint, 4> x) { return first_touch(VfPair(x)); }
std::optional<FirstTouch> first_ee_touch(std::span<const MovingPoint, 4> x) { return first_touch(EePair(x)); }

std::optional<FirstTouch> first_self_touch(std::span<const MovingPoint, 3> x) {
  const OnSegment condition = on_segment(x[0], x[1], x[2]);
  Instant start = Instant::start(), end = Instant::end();
  if (holds(condition, start)) return FirstTouch{start, false};
  if (auto instant = first_time_inside(condition)) return FirstTouch{std::move(*instant), false};
  if (holds(condition, end)) return FirstTouch{end, false};
  return std::nullopt;
}

}  // namespace selvage::verify
