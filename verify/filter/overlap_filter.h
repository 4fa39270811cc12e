// The filter of exact_overlap: cheap proofs that two triangles have nothing in common beyond the vertices they share.
#pragma once

#include <array>

#include "verify/arithmetic/point.h"

namespace selvage::verify {

/// True is a proof, false means "do not know". Zero-area triangles are allowed. Valid for all finite input in the
/// environment of FpGuard. Source of the idea: separating axes; every direction is judged with a proved error bound.
[[nodiscard]] bool triage_apart(const std::array<Point, 3>& a, const std::array<Point, 3>& b);
/// The same for triangles (s, p[0], p[1]) and (s, q[0], q[1]) that share the vertex s: nothing in common beyond s.
[[nodiscard]] bool triage_apart_beyond_vertex(const Point& s, const std::array<Point, 2>& p,
                                              const std::array<Point, 2>& q);
/// The same for triangles (a, b, c) and (a, b, d) that share an edge: nothing in common beyond it. Only non-zero areas
/// are ever proved.
[[nodiscard]] bool triage_apart_beyond_edge(const Point& a, const Point& b, const Point& c, const Point& d);

}  // namespace selvage::verify
