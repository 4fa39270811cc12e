#include "verify/face_block.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "verify/direction.h"

namespace selvage::verify {
namespace {

constexpr std::size_t kWidth = FaceBlock::kWidth;
using Flags = std::array<std::int32_t, kWidth>;  // 0 or -1

/// How far direction . x, as computed, is to be beyond that of all corners of a face, so that x is beyond its plane.
/// u: direction, w = 2^-24, n: the exact normal of the face in its frame (|x_k| <= 1 there), s: a corner.
/// n . (x - s) differs from the difference of the computed u . x and u . s by at most
/// (1) the roundings of two sums of three products, 3 w |u|_1 each, and the stored points, kStoredError |u|_1
/// each: 7.01; (2) |n - u|_1 max |x - s| with max |x - s| <= 2: each component of u rounds once to single, 2.01 w |u|_1
/// in all; before,
///     with e, f the edges, it errs by 8.1 * 2^-53 |e|_max |f|_max (two roundings of the factors and one of the product
///     in each of two products, one of their difference), 48.7 * 2^-53 in all;
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

unsigned bits(const Flags& flags) {
#if defined(__SSE2__)
  const auto half = [&](std::size_t begin) {
    const __m128i lanes = _mm_load_si128(reinterpret_cast<const __m128i*>(&flags[begin]));
    return static_cast<unsigned>(_mm_movemask_ps(_mm_castsi128_ps(lanes)));
  };
  return half(0) | half(4) << 4;
#else
  unsigned mask = 0;
  for (std::size_t i = 0; i < kWidth; ++i) mask |= (flags[i] != 0 ? 1U : 0U) << i;
  return mask;
#endif
}

/// The loops over places below are made for vector units: no branches, no calls. Each processor's version is this code
/// again, so all give the same answers.
#define SELVAGE_INLINE inline __attribute__((always_inline))

constexpr std::int32_t flag(bool holds) { return holds ? -1 : 0; }

using Corners = std::array<FaceBlock::Lanes<float>, 3>;  // of boxes: [axis][place]

SELVAGE_INLINE void bound(const FaceBlock& block, Corners& min, Corners& max) {
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t i = 0; i < kWidth; ++i) {
      const float a = block.corners[0][k][i], b = block.corners[1][k][i], c = block.corners[2][k][i];
      min[k][i] = std::min(std::min(a, b), c);
      max[k][i] = std::max(std::max(a, b), c);
    }
  }
}

SELVAGE_INLINE void flag_meeting(const Corners& mins, const Corners& maxs, const std::array<float, 3>& min,
                                 const std::array<float, 3>& max, Flags& meet) {
  for (std::size_t i = 0; i < kWidth; ++i) {
    meet[i] = -1;
    for (std::size_t k = 0; k < 3; ++k) meet[i] &= flag(mins[k][i] <= max[k]) & flag(min[k] <= maxs[k][i]);
  }
}

/// Where boxes overlap by more than a common boundary they did so before they were rounded.
SELVAGE_INLINE void flag_overlap(const Corners& mins, const Corners& maxs, const FloatFace& face, Flags& overlap) {
  for (std::size_t i = 0; i < kWidth; ++i) {
    overlap[i] = -1;
    for (std::size_t k = 0; k < 3; ++k) overlap[i] &= flag(mins[k][i] < face.max[k]) & flag(face.min[k] < maxs[k][i]);
  }
}

/// Faces lie apart but for what they share if all corners of one that are not shared are strictly above the plane of
/// the other, or all are below (docs/guarantee.md). A shared corner is in that plane and never counted as above or
/// below.
SELVAGE_INLINE void flag_apart(const FaceBlock& block, const FloatFace& face, Flags& neighbour, Flags& apart) {
  for (std::size_t i = 0; i < kWidth; ++i) {
    std::array<std::int32_t, 3> mine{}, theirs{};  // which corners are shared
    for (std::size_t j = 0; j < 3; ++j) {
      for (std::size_t l = 0; l < 3; ++l) {
        const std::int32_t same = flag(face.vertices[j] == block.vertices[l][i]);
        mine[j] |= same;
        theirs[l] |= same;
      }
    }
    std::int32_t their_above = -1, their_below = -1, my_above = -1, my_below = -1;
    for (std::size_t j = 0; j < 3; ++j) {
      const float their_height = face.direction[0] * block.corners[j][0][i] +
                                 face.direction[1] * block.corners[j][1][i] +
                                 face.direction[2] * block.corners[j][2][i];
      their_above &= flag(their_height > face.high) | theirs[j];
      their_below &= flag(their_height < face.low) | theirs[j];
      const float my_height = block.direction[0][i] * face.corners[j][0] + block.direction[1][i] * face.corners[j][1] +
                              block.direction[2][i] * face.corners[j][2];
      my_above &= flag(my_height > block.high[i]) | mine[j];
      my_below &= flag(my_height < block.low[i]) | mine[j];
    }
    const std::int32_t same_face = mine[0] & mine[1] & mine[2];
    neighbour[i] = mine[0] | mine[1] | mine[2];
    apart[i] = (their_above | their_below | my_above | my_below) & ~same_face;
  }
}

SELVAGE_INLINE unsigned compare_any(const FaceBlock& block, const FaceQuery& query, const std::array<float, 3>& min,
                                    const std::array<float, 3>& max, std::array<FaceBlock::Masks, kWidth>& masks) {
  alignas(32) Flags meet, overlap, neighbour, apart;
  flag_meeting(query.min, query.max, min, max, meet);
  unsigned waiting = bits(meet), found = 0;
  if (waiting == 0) return 0;
  alignas(32) Corners mins, maxs;
  bound(block, mins, maxs);
  for (; waiting != 0; waiting &= waiting - 1) {
    const auto i = static_cast<std::size_t>(std::countr_zero(waiting));
    const FloatFace& face = query.faces[i];
    flag_meeting(mins, maxs, face.min, face.max, meet);
    masks[i].meet = bits(meet);
    if (masks[i].meet == 0) continue;
    found |= 1U << i;
    flag_overlap(mins, maxs, face, overlap);
    flag_apart(block, face, neighbour, apart);
    for (std::size_t j = 0; j < kWidth; ++j) apart[j] &= overlap[j] | (meet[j] & neighbour[j]);
    masks[i].apart = bits(apart);
  }
  return found;
}

using Compare = unsigned (*)(const FaceBlock&, const FaceQuery&, const std::array<float, 3>&,
                             const std::array<float, 3>&, std::array<FaceBlock::Masks, kWidth>&);

unsigned compare_baseline(const FaceBlock& block, const FaceQuery& query, const std::array<float, 3>& min,
                          const std::array<float, 3>& max, std::array<FaceBlock::Masks, kWidth>& masks) {
  return compare_any(block, query, min, max, masks);
}

#if defined(__x86_64__)
__attribute__((target("avx2"))) unsigned compare_avx2(const FaceBlock& block, const FaceQuery& query,
                                                      const std::array<float, 3>& min, const std::array<float, 3>& max,
                                                      std::array<FaceBlock::Masks, kWidth>& masks) {
  return compare_any(block, query, min, max, masks);
}
const Compare compare_here = [] {
  __builtin_cpu_init();
  return __builtin_cpu_supports("avx2") ? compare_avx2 : compare_baseline;
}();
#else
constexpr Compare compare_here = compare_baseline;
#endif

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
  const double m = frame.is_exact() ? margin(direction, largest(e) * largest(f))
                                    : std::numeric_limits<double>::infinity();  // no point is beyond
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

FloatFace FaceBlock::get(std::size_t place) const {
  FloatFace face;
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t j = 0; j < 3; ++j) face.corners[j][k] = corners[j][k][place];
    face.direction[k] = direction[k][place];
    face.vertices[k] = vertices[k][place];
    face.min[k] = std::min({corners[0][k][place], corners[1][k][place], corners[2][k][place]});
    face.max[k] = std::max({corners[0][k][place], corners[1][k][place], corners[2][k][place]});
  }
  face.low = low[place];
  face.high = high[place];
  return face;
}

unsigned FaceBlock::compare(const FaceQuery& query, const std::array<float, 3>& min, const std::array<float, 3>& max,
                            std::array<Masks, kWidth>& masks) const {
  return compare_here(*this, query, min, max, masks);
}

FaceQuery::FaceQuery(const FaceBlock& block) {
  for (std::size_t i = 0; i < faces.size(); ++i) faces[i] = block.get(i);
  bound(block, min, max);
}

}  // namespace selvage::verify
