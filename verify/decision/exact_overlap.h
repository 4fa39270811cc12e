// Exact decision whether two triangles of one mesh meet at one instant beyond the vertices they share.
#pragma once

#include <array>
#include <cstdint>

#include "verify/decision/exact_motion.h"

namespace selvage::verify {

enum class OverlapKind : std::uint8_t {
  kNone,
  kTouch,     ///< they meet in a point or segment without piercing
  kPierce,    ///< an edge of one passes through the interior of the other
  kCoplanar,  ///< coplanar with common interior points
  kFold,      ///< they share an edge and lie flat on the same side of it
  kSame,      ///< the same three vertices
};

/// none, touch, cross, overlap (coplanar), fold, duplicate: as in Violation::kind.
[[nodiscard]] const char* name_of(OverlapKind kind);

struct OverlapAnswer {
  OverlapKind kind = OverlapKind::kNone;
  bool exact_used = false;
};

/// Corners by index (to know what is shared) and by position. Zero-area triangles are the union of their edges.
/// Duplicate vertices (equal position, other index) are a touch. Throws std::invalid_argument unless all is finite.
[[nodiscard]] OverlapAnswer exact_overlap(const std::array<std::int32_t, 3>& face_a, const std::array<Point, 3>& a,
                                          const std::array<std::int32_t, 3>& face_b, const std::array<Point, 3>& b);

struct DegenerateAnswer {
  bool is_degenerate = false;
  bool exact_used = false;  ///< whether a sign needed exact arithmetic
};
/// Whether the corners are exactly collinear (or coincide): the face is not embedded, kind `degenerate`. Throws
/// likewise.
[[nodiscard]] DegenerateAnswer exact_degenerate(const std::array<Point, 3>& a);

}  // namespace selvage::verify
