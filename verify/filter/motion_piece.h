// A piece of a motion and what the motion filter computes of it, each with a proved error bound.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "verify/arithmetic/sound_arithmetic.h"

namespace selvage::verify {

inline constexpr int kMaxDepth = 7;  ///< pieces of 1/128 of the step or longer; the error bounds count on it

/// A piece of the step: the coordinates k of the corners j at its start and at its end.
template <std::size_t N>
struct Piece {
  using Corners = std::array<std::array<double, N>, 3>;
  Corners start, end;
  int depth = 0;
};

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
/// whole step as computed, hence also of every piece:
/// (1) D at the ends of the step carries one rounding, u M. A middle adds one, of a sum <= 2 M that is then halved: u M
///     again (halving may underflow by 2^-1075: nothing against u M >= 2^-353). At depth <= 7: 8.01 u M.
/// (2) c, axis x: a product D_iy D_jz is off by (2 * 8.01 + 1) u M_y M_z, a difference of two by
///     2 * 17.1 + 2 = 36.3, the middle coefficient (the mean of two differences) by 36.3 + 2 = 38.3 times u M_y M_z.
///     The bound takes 64.
/// (3) f: a term D_0k c_k, |c_k| <= 2 M_i M_j: 38.3 + 2 * 8.01 + 2 = 56.4 times u P, P = M_x M_y M_z. End coefficients,
///     sums of three terms <= 6 P: 3 * 56.4 + 10 = 180. Three times an inner coefficient, sums of three (a + 2 b):
///     3 * (3 * 56.4 + 6) + 30 = 556, that is 186 for the coefficient. The bound takes 256 (and 3 * 256).
/// The slack pays for the roundings in M products here. kLeast keeps P from underflow, kMax every term from overflow.
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
    return std::ranges::all_of(magnitude_, [](double m) { return m <= kMax; });
  }

  std::array<double, 3> cross{};
  double cubic = 0;

 private:
  static constexpr double kLeast = 0x1p-300, kMax = 0x1p+300;
  std::array<double, 3> magnitude_{};
};

using Quadratic = std::array<double, 3>;  ///< Bernstein coefficients over a piece

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

/// f = D_0 . c_1: its Bernstein coefficients, the inner two times 3. c1: c_1 by coordinate.
template <std::size_t N>
std::array<double, 4> scaled_cubic(const Piece<N>& piece, const std::array<Quadratic, 3>& c1) {
  std::array<double, 4> f{};
  for (std::size_t k = 0; k < 3; ++k) {
    const double start = piece.start[k][0], end = piece.end[k][0];
    f[0] += start * c1[k][0];
    f[1] += end * c1[k][0] + 2 * (start * c1[k][1]);
    f[2] += 2 * (end * c1[k][1]) + start * c1[k][2];
    f[3] += end * c1[k][2];
  }
  return f;
}

}  // namespace selvage::verify
