#include "verify/violation.h"

#include <algorithm>

namespace selvage::verify {

std::array<std::int32_t, 3> corner_first(const std::array<std::int32_t, 3>& face, std::int32_t v) {
  const auto& [a, b, c] = face;
  if (v == a) return {a, b, c};
  return v == b ? std::array{b, c, a} : std::array{c, a, b};
}

Violation describe(const Topology& topology, const Hit& hit) {
  Violation violation;
  violation.event = hit.event;
  violation.kind = hit.kind;
  violation.features = hit.features;
  violation.vertices.fill(-1);
  auto* next = violation.vertices.begin();
  const auto append = [&](const auto& vertices) { next = std::copy(vertices.begin(), vertices.end(), next); };
  const auto vertex = [](std::int32_t v) { return std::array<std::int32_t, 1>{v}; };
  const auto edge = [&](std::int32_t e) { return topology.edges[static_cast<std::size_t>(e)]; };
  const auto face = [&](std::int32_t f) { return topology.triangles[static_cast<std::size_t>(f)]; };
  const auto [first, second] = hit.features;
  switch (hit.event) {
    case EventKind::kVf:
      append(vertex(first));
      append(face(second));
      break;
    case EventKind::kEe:
      append(edge(first));
      append(edge(second));
      break;
    case EventKind::kOverlap:
      append(face(first));
      append(face(second));
      break;
    case EventKind::kSelf:
      append(corner_first(face(second), first));
      break;
  }
  return violation;
}

void set_positions(Violation& violation, std::span<const Point> V_t0, std::span<const Point> V_t1) {
  const double t = violation.t.lower_approx;
  for (const std::int32_t v : violation.vertices) {
    if (v < 0) continue;
    const Point &p = V_t0[static_cast<std::size_t>(v)], &q = V_t1[static_cast<std::size_t>(v)];
    Point at_touch{};
    for (std::size_t k = 0; k < 3; ++k) at_touch[k] = (1 - t) * p[k] + t * q[k];
    violation.x_t0.push_back(p);
    violation.x_t1.push_back(q);
    violation.at_touch.push_back(at_touch);
  }
}

}  // namespace selvage::verify
