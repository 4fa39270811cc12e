#include "verify/violation.h"

#include <algorithm>

namespace selvage::verify {

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
      append(face(second));
      break;
  }
  return violation;
}

}  // namespace selvage::verify
