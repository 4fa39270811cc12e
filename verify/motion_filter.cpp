#include "verify/motion_filter.h"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <cstddef>

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

constexpr int kMaxDepth = 7;    ///< pieces of 1/128 of the step or longer; the error bounds count on it
constexpr int kMaxPieces = 32;  ///< of one query: more are dearer than the exact decision

/// A piece of the step: the coordinates k of the corners j at its start and at its end.
template <std::size_t N>
struct Piece {
  using Corners = std::array<std::array<double, N>, 3>;
  Corners start, end;
  int depth = 0;
};

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

/// The halves of a piece share its middle.
template <std::size_t N>
typename Piece<N>::Corners middle(const Piece<N>& piece) {
  typename Piece<N>::Corners result;
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t j = 0; j < N; ++j) result[k][j] = 0.5 * (piece.start[k][j] + piece.end[k][j]);
  }
  return result;
}

/// Error bounds of the Bernstein coefficients of c and f over any piece. With u = 2^-53 and M_k >= all |D_jk| of the
/// whole step as computed, hence also of every piece: (1) D at the ends of the step carries one rounding, u M. A middle
/// adds one, of a sum <= 2 M that is then halved: u M
///     again (halving may underflow by 2^-1075: nothing against u M >= 2^-353). At depth <= 7: 8.01 u M.
/// (2) c, axis x: a product D_iy D_jz is off by (2 * 8.01 + 1) u M_y M_z, a difference of two by 2 * 17.1 + 2 = 36.3,
/// the
///     middle coefficient (the mean of two differences) by 36.3 + 2 = 38.3 times u M_y M_z. The bound takes 64.
/// (3) f: a term D_0k c_k, |c_k| <= 2 M_i M_j: 38.3 + 2 * 8.01 + 2 = 56.4 times u P, P = M_x M_y M_z. End coefficients,
///     sums of three terms <= 6 P: 3 * 56.4 + 10 = 180. Three times an inner coefficient, sums of three (a + 2 b):
///     3 * (3 * 56.4 + 6) + 30 = 556, that is 186 for the coefficient. The bound takes 256 (and 3 * 256).
/// The slack pays for the roundings in M products here. kLeast keeps P from underflow, kMost every term from overflow.
class ErrorBounds {
 public:
  template <std::size_t N>
  explicit ErrorBounds(const Piece<N>& whole) {
    for (std::size_t k = 0; k < 3; ++k) {
      double most = kLeast;
      for (std::size_t j = 0; j < N; ++j)
        most = std::max({most, std::abs(whole.start[k][j]), std::abs(whole.end[k][j])});
      magnitude_[k] = most;
    }
    for (std::size_t k = 0; k < 3; ++k) cross[k] = 0x1p-47 * magnitude_[(k + 1) % 3] * magnitude_[(k + 2) % 3];
    cubic = 0x1p-45 * magnitude_[0] * magnitude_[1] * magnitude_[2];
  }
  [[nodiscard]] bool hold() const {
    return std::ranges::all_of(magnitude_, [](double m) { return m <= kMost; });
  }

  std::array<double, 3> cross{};
  double cubic = 0;

 private:
  static constexpr double kLeast = 0x1p-300, kMost = 0x1p+300;
  std::array<double, 3> magnitude_{};
};

using Quadratic = std::array<double, 3>;  // Bernstein coefficients over a piece

/// c_j, its coordinate k.
template <std::size_t N>
Quadratic cross(const Piece<N>& piece, std::size_t j, std::size_t k) {
  const std::size_t next = (j + 1) % N;
  const auto &y_start = piece.start[(k + 1) % 3], &z_start = piece.start[(k + 2) % 3];
  const auto &y_end = piece.end[(k + 1) % 3], &z_end = piece.end[(k + 2) % 3];
  return {y_start[j] * z_start[next] - z_start[j] * y_start[next],
          0.5 * ((y_start[j] * z_end[next] - z_start[j] * y_end[next]) +
                 (y_end[j] * z_start[next] - z_end[j] * y_start[next])),
          y_end[j] * z_end[next] - z_end[j] * y_end[next]};
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
  std::array<double, 4> f{};  // Bernstein coefficients, the inner two times 3
  for (std::size_t k = 0; k < 3; ++k) {
    const double start = piece.start[k][0], end = piece.end[k][0];
    f[0] += start * c1[k][0];
    f[1] += end * c1[k][0] + 2 * (start * c1[k][1]);
    f[2] += 2 * (end * c1[k][1]) + start * c1[k][2];
    f[3] += end * c1[k][2];
  }
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
