#include "kernel/proximity.h"

#include <cmath>
#include <limits>

#include "kernel/arithmetic/power_of_two.h"
#include "kernel/arithmetic/rounding.h"
#include "kernel/fp_env.h"
#include "kernel/query/canonical_order.h"
#include "kernel/query/ccd_detail.h"
#include "kernel/query/closest_point.h"
#include "kernel/query/separation.h"

namespace selvage {

namespace detail {

namespace {

/// What is known without an answer: nothing but that distances are not negative. Near, to whoever must be safe.
Proximity unknown_proximity() {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Proximity result;
  result.distance_upper = result.point_error_bound = kInfinity;
  return result;
}

Proximity proximity(PairKind kind, const std::array<Vec3, 4>& x) {
  if (!in_domain(x)) return unknown_proximity();
  const CanonicalOrder order = canonical_order(kind, x.data(), x.data());
  PairPoints points;
  for (std::size_t i = 0; i < 4; ++i) points[i] = to_double3(x[order.original[i]]);
  const PairMotion<double> motion = make_pair_motion<double>(kind, points, points);
  const auto closest = closest_point(kind, motion.t0);
  const double upper = distance_upper(motion, motion.t0, false, closest.weights);
  const auto [lower, direction] = supported_distance(motion, motion.t0, closest);
  // Two roots, because the product under one could underflow.
  const double error = std::sqrt(upper - lower) * std::sqrt(upper + lower) * (1 + kQuotientError);

  Proximity result;
  result.distance_lower = times_power_lower(lower, motion.exponent);
  result.distance_upper = times_power_upper(upper, motion.exponent);
  result.distance = std::min(std::max(times_power(norm(closest.point), motion.exponent), result.distance_lower),
                             result.distance_upper);
  result.point_error_bound = times_power_upper(error, motion.exponent);
  result.weights = restore_weights(order, closest.weights);
  if (upper > 0 && !is_zero(direction)) result.normal = restore_normal(order, scaled(1 / norm(direction), direction));
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

Proximity pair_proximity(PairKind kind, const std::array<Vec3, 4>& x) {
  if (kind == PairKind::kVf) return vf_proximity(x);
  if (kind == PairKind::kEe) return ee_proximity(x);
  return self_proximity({x[0], x[1], x[2]});
}

}  // namespace selvage
