#include "verify/decision/enclosed.h"

#include <algorithm>

#include "verify/arithmetic/fp_guard.h"
#include "verify/arithmetic/predicates.h"

namespace selvage::verify {
namespace {

constexpr int kPoint = 3;  // behind the corners

/// On which side of the line from corner u to corner v the point is, seen from above, where the point is moved by e
/// along the first axis and by e^2 along the second, for an e smaller than all that matters. So no ray meets an edge or
/// a vertex. The sign is that of (v - u) x (point - u), whose derivatives are u[1] - v[1] and v[0] - u[0]. 0: the edge
/// is seen as a point.
int side(Predicates& predicates, int u, int v) {
  if (const int sign = predicates.normal(2, u, v, kPoint); sign != 0) return sign;
  if (const int sign = predicates.compare(1, u, v); sign != 0) return sign;
  return predicates.compare(0, v, u);
}

/// Of faces that are seen as a line there is none above the moved point.
bool is_below(const Point& point, const std::array<Point, 3>& face) {
  const std::array points{face[0], face[1], face[2], point};
  Predicates predicates(points);
  const int orientation = side(predicates, 0, 1);
  if (orientation == 0 || side(predicates, 1, 2) != orientation || side(predicates, 2, 0) != orientation) return false;
  return predicates.orient3d(0, 1, 2, kPoint) == -orientation;
}

/// A box that the ray does not come near: most of the faces, in a few nanoseconds each.
bool may_be_below(const Point& point, const std::array<Point, 3>& face) {
  for (const std::size_t axis : {0U, 1U}) {
    const auto [lower, upper] = std::minmax({face[0][axis], face[1][axis], face[2][axis]});
    if (point[axis] < lower || point[axis] > upper) return false;
  }
  return point[2] <= std::max({face[0][2], face[1][2], face[2][2]});
}

}  // namespace

bool is_enclosed(const Point& point, std::span<const std::array<std::int32_t, 3>> faces, std::span<const Point> V) {
  const FpGuard guard;
  bool is_inside = false;
  for (const auto& corners : faces) {
    std::array<Point, 3> face;
    for (std::size_t k = 0; k < 3; ++k) face[k] = V[static_cast<std::size_t>(corners[k])];
    if (may_be_below(point, face) && is_below(point, face)) is_inside = !is_inside;
  }
  return is_inside;
}

}  // namespace selvage::verify
