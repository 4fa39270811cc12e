#include "verify/filter/motion_filter.h"

#include <cfloat>
#include <cstddef>

#include "verify/filter/motion_piece.h"

namespace selvage::verify {
namespace {

static_assert(FLT_EVAL_METHOD == 0 && DBL_MANT_DIG == 53, "the error bounds below are for IEEE doubles");

// Two features touch iff the origin is in the set of differences between their points. That set is a convex polygon of
// N corners D_0 ... D_{N-1}, in order around it: a triangle for vertex-face, a parallelogram for edge-edge, a segment
// for a point and an edge. With f = D_0 . (D_1 x D_2) and c_j = D_j x D_{j+1} (indices mod N; N = 2: only c):
//   f = 0 is necessary, and so is that for every axis k the c_jk have one sign or are 0 (each is a weight times n_k,
//   where n is the normal), also where the polygon is degenerate. If f = 0 and for one axis all are positive, or all
//   negative, the origin is in the polygon's interior.
// The step is cut into pieces until the signs of Bernstein coefficients over each piece prove one thing or the other.

constexpr int kMaxPieces = 32;  ///< of one query: more are dearer than the exact decision

/// All positive or all negative. Of differences of doubles the sign is exact, so this needs no error bound.
template <std::size_t N>
bool on_one_side(const std::array<double, N>& start, const std::array<double, N>& end) {
  bool all_positive = true, all_negative = true;
  for (std::size_t j = 0; j < N; ++j) {
    all_positive &= start[j] > 0 && end[j] > 0;
    all_negative &= start[j] < 0 && end[j] < 0;
  }
  return all_positive || all_negative;
}

/// 1, -1: proved positive or negative; 0: not known. NaN is not known.
int proved_sign(double value, double bound) { return (value > bound ? 1 : 0) - (value < -bound ? 1 : 0); }
int proved_sign(const Quadratic& q, double bound) {
  if (q[0] > bound && q[1] > bound && q[2] > bound) return 1;
  if (q[0] < -bound && q[1] < -bound && q[2] < -bound) return -1;
  return 0;
}

/// What the coplanarity cubic says about a piece.
enum class Coplanarity : std::uint8_t { kNever, kOnceCrossing, kUnknown };

template <std::size_t N>
Coplanarity coplanarity(const Piece<N>& piece, const std::array<Quadratic, 3>& c1, double bound) {
  const std::array<double, 4> f = scaled_cubic(piece, c1);
  const std::array<int, 4> sign = {proved_sign(f[0], bound), proved_sign(f[1], 3 * bound), proved_sign(f[2], 3 * bound),
                                   proved_sign(f[3], bound)};
  if (sign[0] * sign[1] * sign[2] * sign[3] == 0) return Coplanarity::kUnknown;
  const int changes = (sign[0] != sign[1] ? 1 : 0) + (sign[1] != sign[2] ? 1 : 0) + (sign[2] != sign[3] ? 1 : 0);
  if (changes == 0) return Coplanarity::kNever;
  return changes == 1 ? Coplanarity::kOnceCrossing : Coplanarity::kUnknown;  // one change: one root, and it is simple
}

template <std::size_t N>
MotionTriage triage(const Piece<N>& piece, const ErrorBounds& bounds) {
  std::array<Quadratic, 3> c1{};
  Coplanarity plane = Coplanarity::kUnknown;
  if constexpr (N > 2) {
    for (std::size_t k = 0; k < 3; ++k) c1[k] = cross(piece, 1, k);
    plane = coplanarity(piece, c1, bounds.cubic);
    if (plane == Coplanarity::kNever) return MotionTriage::kApart;
  }
  bool is_inside = false;
  for (std::size_t k = 0; k < 3; ++k) {
    std::size_t positive = 0, negative = 0;
    for (std::size_t j = 0; j < N; ++j) {
      const int sign = proved_sign(N > 2 && j == 1 ? c1[k] : cross(piece, j, k), bounds.cross[k]);
      if (sign > 0) ++positive;
      if (sign < 0) ++negative;
      if (positive > 0 && negative > 0) return MotionTriage::kApart;
    }
    is_inside |= positive == N || negative == N;
  }
  return is_inside && plane == Coplanarity::kOnceCrossing ? MotionTriage::kCrosses : MotionTriage::kUnresolved;
}

/// The corners are the differences of the numbered points.
template <std::size_t N, std::size_t M>
MotionTriage triage_motion(const std::array<Point, M>& x_t0, const std::array<Point, M>& x_t1,
                           const std::array<std::array<std::size_t, 2>, N>& corners) {
  Piece<N> whole;
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t j = 0; j < N; ++j) {
      whole.start[k][j] = x_t0[corners[j][0]][k] - x_t0[corners[j][1]][k];
      whole.end[k][j] = x_t1[corners[j][0]][k] - x_t1[corners[j][1]][k];
    }
    if (on_one_side(whole.start[k], whole.end[k])) return MotionTriage::kApart;
  }
  const ErrorBounds bounds(whole);
  if (!bounds.hold()) return MotionTriage::kUnresolved;
  // In the order of time: where a piece crosses, all before it are apart, so the crossing is the first touch.
  std::array<Piece<N>, kMaxDepth + 1> pending;
  std::size_t count = 0;
  pending[count++] = whole;
  for (int pieces = 0; count > 0; ++pieces) {
    const Piece<N> piece = pending[--count];
    const MotionTriage answer = triage(piece, bounds);
    if (answer == MotionTriage::kApart) continue;
    if (answer == MotionTriage::kCrosses) return answer;
    if (piece.depth == kMaxDepth || pieces == kMaxPieces) return MotionTriage::kUnresolved;
    const auto cut = middle(piece);
    pending[count++] = {cut, piece.end, piece.depth + 1};
    pending[count++] = {piece.start, cut, piece.depth + 1};
  }
  return MotionTriage::kApart;
}

}  // namespace

MotionTriage triage_vf_motion(const std::array<Point, 4>& x_t0, const std::array<Point, 4>& x_t1) noexcept {
  return triage_motion<3>(x_t0, x_t1, {{{0, 1}, {0, 2}, {0, 3}}});
}

MotionTriage triage_ee_motion(const std::array<Point, 4>& x_t0, const std::array<Point, 4>& x_t1) noexcept {
  return triage_motion<4>(x_t0, x_t1, {{{0, 2}, {0, 3}, {1, 3}, {1, 2}}});
}

MotionTriage triage_self_motion(const std::array<Point, 3>& x_t0, const std::array<Point, 3>& x_t1) noexcept {
  return triage_motion<2>(x_t0, x_t1, {{{0, 1}, {0, 2}}});
}

}  // namespace selvage::verify
