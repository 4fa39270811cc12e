// The times at which a coplanarity cubic may vanish, as few and as narrow intervals as its error bound allows.
#pragma once

#include "kernel/query/coplanarity.h"

namespace selvage::detail {

/// A cubic has three roots; near-double ones may come as more pieces, which are then joined.
struct RootIntervals {
  std::array<TickInterval, 4> interval = {};
  int count = 0;
  int examined = 0;  ///< pieces of time looked at
};

/// PROVED: every root in [0,1] lies in one of the closed intervals, which are disjoint and sorted. A cubic that is zero
/// within its bound gives the whole of [0,1]; a simple root an interval of about error_bound / slope. Examines at most
/// `max_examined` pieces, and at most kMaxIsolation (K8); what is left over then is kept whole.
[[nodiscard]] RootIntervals root_intervals(const CoplanarityCubic<double>& cubic, int max_examined);
/// Twice the bisections that a double root can take, and the pieces that these leave open.
inline constexpr int kMaxIsolation = 256;

/// A root in [0,1] of a cubic in Bernstein form that changes sign, or the end where it is zero: a guess, at which the
/// cubic is hoped to be within `residual` of zero.
[[nodiscard]] double root_fraction(const std::array<double, 4>& coefficient, double residual);

}  // namespace selvage::detail
