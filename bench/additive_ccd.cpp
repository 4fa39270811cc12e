#include "bench/additive_ccd.h"

#include <algorithm>
#include <cmath>

#include "bench/plain_distance.h"

namespace selvage::bench {
namespace {

using Points = std::array<Vec3, 4>;

/// What all four share does not bring them closer.
Points without_mean(const Points& x_t0, const Points& x_t1) {
  Points v;
  for (std::size_t i = 0; i < 4; ++i) v[i] = x_t1[i] - x_t0[i];
  const Vec3 mean = 0.25 * (v[0] + v[1] + v[2] + v[3]);
  for (Vec3& of_point : v) of_point -= mean;
  return v;
}

/// `speed` bounds how fast the two features approach, in lengths a step.
template <typename Distance>
AdditiveAnswer advance(Points x, const Points& v, double speed, const AdditiveOptions& options, Distance distance) {
  double apart = distance(x);
  if (!(apart > 0)) return {true, false, 0};
  if (speed == 0) return {};
  const double gap = (1 - options.rescaling) * apart;
  double toi = 0;
  for (std::int32_t step = 0; step < options.max_steps; ++step) {
    const double advance = options.rescaling * apart / speed;
    if (std::isnan(advance)) return {true, true, toi};  // both overflowed
    for (std::size_t i = 0; i < 4; ++i) x[i] += advance * v[i];
    apart = distance(x);
    // The first step cannot end nearer than `gap`, but for rounding. `!(>=)` takes a NaN for near.
    if (toi > 0 && !(apart >= gap)) return {true, false, toi};
    toi += advance;
    if (toi > 1) return {};
  }
  return {true, true, toi};
}

}  // namespace

AdditiveAnswer additive_vf(const Points& x_t0, const Points& x_t1, const AdditiveOptions& options) {
  const Points v = without_mean(x_t0, x_t1);
  const double speed = v[0].norm() + std::max({v[1].norm(), v[2].norm(), v[3].norm()});
  return advance(x_t0, v, speed, options, plain_vf_distance);
}

AdditiveAnswer additive_ee(const Points& x_t0, const Points& x_t1, const AdditiveOptions& options) {
  const Points v = without_mean(x_t0, x_t1);
  const double speed = std::max(v[0].norm(), v[1].norm()) + std::max(v[2].norm(), v[3].norm());
  return advance(x_t0, v, speed, options, plain_ee_distance);
}

}  // namespace selvage::bench
