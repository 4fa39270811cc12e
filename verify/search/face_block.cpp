#include "verify/search/face_block.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "verify/arithmetic/gaps.h"

namespace selvage::verify {
namespace {

/// How far direction . x, as computed, is to be beyond that of all corners of a face, so that x is beyond its plane.
/// u: direction, w = 2^-24, n: the exact normal of the face in its frame (|x_k| <= 1 there), s: a corner.
/// n . (x - s) differs from the difference of the computed u . x and u . s by at most
/// (1) the roundings of two sums of three products, 3 w |u|_1 each, and the stored points, kStoredError |u|_1 each:
///     7.01;
/// (2) |n - u|_1 max |x - s| with max |x - s| <= 2: each component of u rounds once to single, 2.01 w |u|_1 in all;
///     before, with e, f the edges, it errs by 8.1 * 2^-53 |e|_max |f|_max (two roundings of the factors and one of
///     the product in each of two products, one of their difference), 48.7 * 2^-53 in all;
/// (3) the rounding of high or low: 1.01 w |u|_1.
/// 10.1 w |u|_1 + 2^-47 |e|_max |f|_max; 11 leaves room for the roundings here. Underflow in (1) and (2) stays below
/// 2^-140.
double margin(const std::array<float, 3>& u, double edges) {
  const double size =
      std::abs(static_cast<double>(u[0])) + std::abs(static_cast<double>(u[1])) + std::abs(static_cast<double>(u[2]));
  return 11 * 0x1p-24 * size + 0x1p-47 * edges + 0x1p-130;
}

double largest(const Point& v) { return std::max({std::abs(v[0]), std::abs(v[1]), std::abs(v[2])}); }

float projection(const std::array<float, 3>& u, const std::array<float, 3>& x) {
  return u[0] * x[0] + u[1] * x[1] + u[2] * x[2];
}

}  // namespace

FloatFace::FloatFace(const std::array<std::int32_t, 3>& triangle, std::span<const Point> V, const FloatFrame& frame)
    : vertices(triangle) {
  const auto at = [V](std::int32_t v) -> const Point& { return V[static_cast<std::size_t>(v)]; };
  const Point &a = at(triangle[0]), &b = at(triangle[1]), &c = at(triangle[2]);
  for (std::size_t k = 0; k < 3; ++k) {
    corners[0][k] = frame(k, a[k]);
    corners[1][k] = frame(k, b[k]);
    corners[2][k] = frame(k, c[k]);
    min[k] = std::min({corners[0][k], corners[1][k], corners[2][k]});
    max[k] = std::max({corners[0][k], corners[1][k], corners[2][k]});
  }
  const Point e = frame.difference(b, a), f = frame.difference(c, a), n = cross(e, f);
  for (std::size_t k = 0; k < 3; ++k) direction[k] = static_cast<float>(n[k]);
  const float p = projection(direction, corners[0]), q = projection(direction, corners[1]),
              r = projection(direction, corners[2]);
  low = -std::numeric_limits<float>::infinity();  // no point is beyond
  high = std::numeric_limits<float>::infinity();
  if (!frame.is_exact() || !frame.holds(a) || !frame.holds(b) || !frame.holds(c)) return;
  const double m = margin(direction, largest(e) * largest(f));
  low = static_cast<float>(static_cast<double>(std::min({p, q, r})) - m);
  high = static_cast<float>(static_cast<double>(std::max({p, q, r})) + m);
}

FaceBlock::FaceBlock() : direction{}, low{}, high{}, vertices{} {
  // No box reaches infinity, so nothing meets these.
  for (auto& corner : corners) {
    for (auto& axis : corner) axis.fill(std::numeric_limits<float>::infinity());
  }
  for (auto& corner : vertices) corner.fill(-1);
}

void FaceBlock::set(std::size_t place, const FloatFace& face) {
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t j = 0; j < 3; ++j) corners[j][k][place] = face.corners[j][k];
    direction[k][place] = face.direction[k];
    vertices[k][place] = face.vertices[k];
  }
  low[place] = face.low;
  high[place] = face.high;
}

}  // namespace selvage::verify
