// Points as single-precision numbers in [-1, 1]^3, with a proved error: what the first filter of the frame check reads.
#pragma once

#include <algorithm>
#include <cmath>

#include "verify/search/box_block.h"

namespace selvage::verify {

/// X = (x / 2 - center / 2) scale is the same similarity for all points, exactly; operator() is X as stored, for a
/// point that the frame holds: |stored - X| <= kStoredError per axis. Halves keep differences finite. A coordinate
/// beyond the frame is stored at its end, so no order is reversed. (1) x / 2 - center_half rounds once, by 2^-53 at
/// most where |X| <= 1; what halving a subnormal loses, and what the
///     product loses, is below 2^-1073 scale <= 2^-73. (2) The conversion rounds by 2^-25, or by 2^-150 below 2^-126.
struct FloatFrame {
  static constexpr double kStoredError = 0x1.001p-25;

  Point center_half{};
  double scale = 1;  ///< a power of two <= 2^1000
  /// Whether differences are as exact as they say: not in a mesh smaller than 2^-900.
  [[nodiscard]] bool is_exact() const { return scale <= 0x1p+900; }

  [[nodiscard]] float operator()(std::size_t axis, double x) const {
    return static_cast<float>(std::clamp(unrounded(axis, x), -1.0, 1.0));
  }
  /// Not where |X| > 1, of which operator() makes 1 at least.
  [[nodiscard]] bool holds(const Point& x) const {
    return std::abs(unrounded(0, x[0])) < 1 && std::abs(unrounded(1, x[1])) < 1 && std::abs(unrounded(2, x[2])) < 1;
  }
  /// (a - b) scale / 2 with a relative error of 2^-53 and, where is_exact(), an absolute one of 2^-173.
  [[nodiscard]] Point difference(const Point& a, const Point& b) const {
    Point d;
    for (std::size_t k = 0; k < 3; ++k) d[k] = (a[k] * 0.5 - b[k] * 0.5) * scale;
    return d;
  }
  /// The largest that keeps `bounds` in [-1, 1]^3.
  static FloatFrame over(const Box& bounds);

 private:
  [[nodiscard]] double unrounded(std::size_t axis, double x) const { return (x * 0.5 - center_half[axis]) * scale; }
};

}  // namespace selvage::verify
