#include "kernel/proximity.h"

#include <cmath>
#include <limits>

#include "kernel/canonical_order.h"
#include "kernel/ccd_detail.h"
#include "kernel/closest_point.h"
#include "kernel/fp_env.h"
#include "kernel/rounding.h"

namespace selvage {

namespace detail {

namespace {

/// What is known without an answer: nothing but that distances are not negative.
Proximity unknown_proximity() {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Proximity result;
  result.distance = result.distance_upper = result.point_error_bound = kInfinity;
  return result;
}

Proximity proximity(PairKind kind, const std::array<Vec3, 4>& x) {
  const std::array<Double3, 4> points = {to_double3(x[0]), to_double3(x[1]), to_double3(x[2]), to_double3(x[3])};
  if (!in_domain(points)) return unknown_proximity();
  const CanonicalPair pair = canonical_order(kind, points, points);
  const PairMotion motion = make_pair_motion(kind, pair.x_t0, pair.x_t1);
  const ClosestPoint closest = closest_point(kind, motion.t0);
  const double upper = distance_upper(kind, motion.t0, Double3{}, motion.exact_scaling, closest.weights);
  const double lower =
      std::max(distance_lower(motion.corner_count, motion.t0, motion.extent, closest.direction),
               distance_lower(motion.corner_count, motion.t0, motion.extent, normalize_exponent(closest.point)));
  const double error = std::sqrt((upper - lower) * (upper + lower)) * (1 + 8 * kUnitRoundoff);

  Proximity result;
  result.distance_lower = scale_down(lower, motion.exponent);
  result.distance_upper = scale_up(upper, motion.exponent);
  result.distance = std::min(std::max(scale_down(norm(closest.point), motion.exponent), result.distance_lower),
                             result.distance_upper);
  result.point_error_bound = scale_up(error, motion.exponent);
  result.weights = restore_weights(pair, closest.weights);
  if (upper > 0 && !is_zero(closest.direction)) {
    result.normal = to_vec3(restore_normal(pair, (1 / norm(closest.direction)) * closest.direction));
  }
  return result;
}

}  // namespace

Proximity vf_proximity_unguarded(const std::array<Vec3, 4>& x) { return proximity(PairKind::kVf, x); }
Proximity ee_proximity_unguarded(const std::array<Vec3, 4>& x) { return proximity(PairKind::kEe, x); }

}  // namespace detail

Proximity vf_proximity(const std::array<Vec3, 4>& x) {
  const FpEnvGuard guard;
  return detail::vf_proximity_unguarded(x);
}

Proximity ee_proximity(const std::array<Vec3, 4>& x) {
  const FpEnvGuard guard;
  return detail::ee_proximity_unguarded(x);
}

}  // namespace selvage
