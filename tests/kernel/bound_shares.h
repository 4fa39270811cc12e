// How much of each bound of kernel/arithmetic/rounding.h rounding can use: a climb towards the worst case, one random
// change after another, against exact rationals. More than all of it would be a wrong bound, next to nothing a loose
// one.
#pragma once

#include <array>
#include <span>

#include "kernel/arithmetic/time_ticks.h"
#include "kernel/query/pair_motion.h"
#include "tests/kernel/random_points.h"

namespace selvage::testing {

/// All that a bound may be asked about. Full significands of several magnitudes, so that every operation rounds.
struct BoundCase {
  PairKind kind = PairKind::kVf;
  detail::PairPoints x_t0, x_t1;
  std::array<detail::Tick, 2> tick = {};
  detail::Triple<detail::DoubleDouble> n;
  std::array<double, 4> weights = {};
};

struct Bound {
  const char* name;
  double (*share_of)(const BoundCase&);  ///< |computed - real| / bound
  double least_share = 0.05;             ///< that climbs must reach
};
[[nodiscard]] std::span<const Bound> bounds();

/// The largest share that one climb from a random case finds.
[[nodiscard]] double climb(const Bound& bound, Random& random);

}  // namespace selvage::testing
