#include "kernel/query/root_intervals.h"

#include <algorithm>
#include <cmath>

namespace selvage::detail {

namespace {

/// A piece whose coefficients are all below this many error bounds is kept whole: within it nothing can be told apart.
constexpr double kFlatFactor = 4;
/// Steps on a bracketed simple root; from within 2^-4 of it three reach the precision of doubles.
constexpr int kRootSteps = 8;

double slope_at(const std::array<double, 4>& c, double t) {
  const double s = 1 - t;
  const double a = c[1] - c[0], b = c[2] - c[1], d = c[3] - c[2];
  return 3 * (s * (s * a + t * b) + t * (s * b + t * d));
}

/// PROVED when not 0: the exact cubic has at most one root in the interval of these coefficients, is below zero before
/// it and above after it (1), or the other way round (-1). By Descartes' rule: whatever the signs of the coefficients
/// that the bound leaves open, the four change sign at most once.
int passage(const std::array<double, 4>& c, double bound) {
  const auto rises = [bound](double c0, double c1, double c2, double c3) {
    const bool below = c0 < -bound && c1<-bound, above = c2> bound && c3 > bound;
    return (below && (c2 < -bound || c3 > bound)) || (above && (c1 > bound || c0 < -bound));
  };
  if (rises(c[0], c[1], c[2], c[3])) return 1;
  return rises(-c[0], -c[1], -c[2], -c[3]) ? -1 : 0;
}

class Isolation {
 public:
  Isolation(const CoplanarityCubic<double>& cubic, int max_examined) : cubic_(cubic), left_(max_examined) {}

  RootIntervals run() {
    examine({0, kTicks});
    return result_;
  }

 private:
  void examine(const TickInterval& piece);
  bool narrow_to_single_root(const TickInterval& piece, const std::array<double, 4>& local, int side_after);
  void emit(const TickInterval& piece);

  const CoplanarityCubic<double>& cubic_;
  int left_;  // pieces that may still be examined
  RootIntervals result_;
};

void Isolation::examine(const TickInterval& piece) {
  if (left_ == 0) return emit(piece);
  --left_;
  ++result_.examined;
  const std::array<double, 4> local = local_coefficients(cubic_, piece);
  const auto [least, greatest] = std::minmax({local[0], local[1], local[2], local[3]});
  const double bound = cubic_.error_bound;
  if (least > bound || greatest < -bound) return;
  const Tick width = piece.end - piece.begin;
  const bool flat = least > -kFlatFactor * bound && greatest < kFlatFactor * bound;
  if (flat || width == 1) return emit(piece);
  const int side_after = passage(local, bound);
  if (side_after != 0 && narrow_to_single_root(piece, local, side_after)) return;
  const Tick middle = piece.begin + width / 2;
  examine({piece.begin, middle});
  examine({middle, piece.end});
}

/// Guesses the root and a margin around it. Where the cubic has the sign that it has on one side of its only root, all
/// on that side is free of roots; where it has not, nothing is claimed.
bool Isolation::narrow_to_single_root(const TickInterval& piece, const std::array<double, 4>& local, int side_after) {
  const double bound = cubic_.error_bound;
  const double root = root_fraction(local, 0.125 * bound);
  const double margin = 1.5 * bound / std::fabs(slope_at(local, root));
  const auto width = static_cast<double>(piece.end - piece.begin);
  const double first = std::floor((root - margin) * width) - 1, last = std::ceil((root + margin) * width) + 1;
  if (!(last - first < width)) return false;
  TickInterval inner = piece;
  if (first > 0) inner.begin += static_cast<Tick>(first);
  if (last < width) inner.end = piece.begin + static_cast<Tick>(last);
  const auto proved = [this, bound](Tick tick, int side) { return side * value_at(cubic_, time_of(tick)) > bound; };
  if (inner.begin > piece.begin && !proved(inner.begin, -side_after)) return false;
  if (inner.end < piece.end && !proved(inner.end, side_after)) return false;
  emit(inner);
  return true;
}

void Isolation::emit(const TickInterval& piece) {
  const auto last = static_cast<std::size_t>(result_.count);
  const bool full = result_.count == static_cast<int>(result_.interval.size());
  if (result_.count > 0 && (full || result_.interval[last - 1].end == piece.begin)) {
    result_.interval[last - 1].end = piece.end;
    return;
  }
  result_.interval[last] = piece;
  ++result_.count;
}

}  // namespace

// Halley's method, kept inside the bracket.
double root_fraction(const std::array<double, 4>& c, double residual) {
  const bool rising = c[0] < c[3];
  if ((c[0] < 0) != rising) return 0;
  if ((c[3] > 0) != rising) return 1;
  const double linear = 3 * (c[1] - c[0]), square = 3 * ((c[2] - c[1]) - (c[1] - c[0])),
               cube = (c[3] - c[0]) - 3 * (c[2] - c[1]);
  double low = 0, high = 1, t = c[0] / (c[0] - c[3]);
  for (int step = 0; step < kRootSteps; ++step) {
    const double value = ((cube * t + square) * t + linear) * t + c[0];
    if (std::fabs(value) <= residual) break;
    ((value < 0) == rising ? low : high) = t;
    const double slope = (3 * cube * t + 2 * square) * t + linear, half_curvature = 3 * cube * t + square;
    const double next = t - value * slope / (slope * slope - value * half_curvature);
    t = next > low && next < high ? next : 0.5 * (low + high);
  }
  return t;
}

RootIntervals root_intervals(const CoplanarityCubic<double>& cubic, int max_examined) {
  return Isolation(cubic, std::min(max_examined, kMaxIsolation)).run();
}

}  // namespace selvage::detail
