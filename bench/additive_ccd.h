// Conservative advancement, as additive CCD does it (Li, Kaufman, Jiang, "Codimensional incremental potential contact",
// 2021, section 5): time advances by as much as the features could at most have come closer, until their distance is
// the share 1 - rescaling of what it was at t = 0, or the step is over. Plain doubles.
//
// Over the real numbers it misses nothing, and its time of impact is never late. Rounding takes that away: the distance
// has no error bound, and positions are sums of steps, each rounded to u |x|. What it misses: features that touch at t
// = 0 and part, where the computed distance is not 0; and contacts of motions so short, or so far from the origin, that
// the distance it keeps, (1 - rescaling) d(0), is below some u max |x|: it steps over them. A pair near which it stops
// is an alarm, though it may never touch.
#pragma once

#include <array>

#include "kernel/types.h"

namespace selvage::bench {

struct AdditiveOptions {
  double rescaling = 0.9;            ///< in (0, 1): share of the possible approach that is used up at once
  std::int32_t max_steps = 1 << 14;  ///< when reached, an alarm at the time that was reached
};

struct AdditiveAnswer {
  bool collides = false;
  bool gave_up = false;  ///< max_steps was reached
  double toi = 1;        ///< 1 where it does not collide
};

/// x = {p, a, b, c}.
[[nodiscard]] AdditiveAnswer additive_vf(const std::array<Vec3, 4>& x_t0, const std::array<Vec3, 4>& x_t1,
                                         const AdditiveOptions& options);
/// x = {a, b, c, d}: edge (a, b) against edge (c, d).
[[nodiscard]] AdditiveAnswer additive_ee(const std::array<Vec3, 4>& x_t0, const std::array<Vec3, 4>& x_t1,
                                         const AdditiveOptions& options);

}  // namespace selvage::bench
