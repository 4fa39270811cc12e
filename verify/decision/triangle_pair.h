// Exact decisions about two closed triangles whose corners are named points; zero-area triangles are the union of their
// edges. Proofs are in docs/guarantee-checker.md, "Checker: frames".
#pragma once

#include "verify/arithmetic/predicates.h"

namespace selvage::verify {

/// A triangle by the names of its points; axis: Predicates::projection_axis, -1 for zero area.
struct Corners {
  int a, b, c;
  int axis;
  [[nodiscard]] bool flat() const { return axis < 0; }
};

class TrianglePair {
 public:
  explicit TrianglePair(Predicates& signs) : signs_(signs) {}

  [[nodiscard]] Corners corners(int a, int b, int c) { return {a, b, c, signs_.projection_axis(a, b, c)}; }

  /// Whether they have a point in common.
  [[nodiscard]] bool meet(const Corners& t, const Corners& u);
  /// Both hold the vertex t.a = u.a: whether they have another point in common.
  [[nodiscard]] bool meet_beyond_vertex(const Corners& t, const Corners& u);
  /// Both hold the edge t.a = u.a, t.b = u.b: whether they have a point off it in common.
  [[nodiscard]] bool meet_beyond_edge(const Corners& t, const Corners& u);

  /// Coplanar with a common region. REQUIRES no flat triangle.
  [[nodiscard]] bool share_area(const Corners& t, const Corners& u);
  /// Not coplanar, and relative interiors meet (of a flat triangle: of its longest edge).
  [[nodiscard]] bool pierce(const Corners& t, const Corners& u);

 private:
  int side(const Corners& t, int p) { return signs_.orient3d(t.a, t.b, t.c, p); }
  bool on_segment(int p, int x, int y);
  bool segments_meet(int p, int q, int x, int y);
  bool in_triangle(int p, const Corners& t);
  bool on_triangle(int p, const Corners& t);
  bool segment_meets_triangle(int p, int q, const Corners& t);
  bool edges_meet_triangle(const Corners& t, const Corners& u);
  bool segment_pierces(int p, int q, const Corners& t);
  bool same_direction(int s, int p, int q);
  bool spoke_meets(int s, int p, const Corners& u);
  bool edge_separates(int p, int q, int inner, const Corners& u, int axis);

  Predicates& signs_;
};

}  // namespace selvage::verify
