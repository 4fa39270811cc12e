#include "verify/decision/exact_overlap.h"

#include <utility>

#include "verify/arithmetic/fp_guard.h"
#include "verify/arithmetic/predicates.h"
#include "verify/decision/triangle_pair.h"
#include "verify/filter/overlap_filter.h"

namespace selvage::verify {
namespace {

/// Corners of both faces in an order that puts the shared ones first, in the same places of both.
struct Matched {
  std::array<std::size_t, 3> a = {0, 1, 2}, b = {0, 1, 2};
  std::size_t shared = 0;
};

bool shares(const std::array<std::int32_t, 3>& face, std::int32_t v) {
  return face[0] == v || face[1] == v || face[2] == v;
}

Matched match(const std::array<std::int32_t, 3>& face_a, const std::array<std::int32_t, 3>& face_b) {
  Matched matched;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = matched.shared; j < 3; ++j) {
      if (face_a[i] != face_b[matched.b[j]]) continue;
      std::swap(matched.b[matched.shared], matched.b[j]);
      // Corner i of a moves to the front; the corners before it that are not shared move back by one.
      for (std::size_t k = i; k > matched.shared; --k) std::swap(matched.a[k], matched.a[k - 1]);
      ++matched.shared;
      break;
    }
  }
  return matched;
}

/// REQUIRES corners as in Matched.
bool triage_none_beyond_shared(std::size_t shared, const std::array<Point, 3>& a, const std::array<Point, 3>& b) {
  if (shared == 1) return triage_apart_beyond_vertex(a[0], {a[1], a[2]}, {b[1], b[2]});
  return shared == 2 && triage_apart_beyond_edge(a[0], a[1], a[2], b[2]);
}

OverlapKind decide(std::size_t shared, TrianglePair& pair, const Corners& t, const Corners& u) {
  const bool flat = t.flat() || u.flat();
  if (shared == 2) {
    if (!pair.meet_beyond_edge(t, u)) return OverlapKind::kNone;
    return flat ? OverlapKind::kTouch : OverlapKind::kFold;
  }
  if (!(shared == 1 ? pair.meet_beyond_vertex(t, u) : pair.meet(t, u))) return OverlapKind::kNone;
  if (!flat && pair.share_area(t, u)) return OverlapKind::kCoplanar;
  return pair.pierce(t, u) ? OverlapKind::kPierce : OverlapKind::kTouch;
}

}  // namespace

const char* name_of(OverlapKind kind) {
  switch (kind) {
    case OverlapKind::kNone:
      return "none";
    case OverlapKind::kTouch:
      return "touch";
    case OverlapKind::kPierce:
      return "cross";
    case OverlapKind::kCoplanar:
      return "overlap";
    case OverlapKind::kFold:
      return "fold";
    case OverlapKind::kSame:
      return "duplicate";
  }
  return "unknown";
}

OverlapAnswer exact_overlap(const std::array<std::int32_t, 3>& face_a, const std::array<Point, 3>& a,
                            const std::array<std::int32_t, 3>& face_b, const std::array<Point, 3>& b) {
  require_finite(a, "exact overlap");
  require_finite(b, "exact overlap");
  const FpGuard guard;
  const bool share_none = !shares(face_a, face_b[0]) && !shares(face_a, face_b[1]) && !shares(face_a, face_b[2]);
  if (share_none && triage_apart(a, b)) return {OverlapKind::kNone, false};
  const Matched matched = match(face_a, face_b);
  if (matched.shared == 3) return {OverlapKind::kSame, false};
  const std::array<Point, 3> p = {a[matched.a[0]], a[matched.a[1]], a[matched.a[2]]};
  const std::array<Point, 3> q = {b[matched.b[0]], b[matched.b[1]], b[matched.b[2]]};
  if (triage_none_beyond_shared(matched.shared, p, q)) return {OverlapKind::kNone, false};

  const std::array<Point, 6> points = {p[0], p[1], p[2], q[0], q[1], q[2]};
  Predicates signs(points);
  TrianglePair pair(signs);
  const auto name = [&](std::size_t i) { return static_cast<int>(i < matched.shared ? i : i + 3); };
  const OverlapKind kind = decide(matched.shared, pair, pair.corners(0, 1, 2), pair.corners(name(0), name(1), name(2)));
  return {kind, signs.exact_used()};
}

DegenerateAnswer exact_degenerate(const std::array<Point, 3>& a) {
  require_finite(a, "exact overlap");
  const FpGuard guard;
  Predicates signs(a);
  const bool is_degenerate = signs.projection_axis(0, 1, 2) < 0;
  return {is_degenerate, signs.exact_used()};
}

}  // namespace selvage::verify
