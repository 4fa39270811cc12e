#include "kernel/query/ccd_answer.h"

#include "kernel/arithmetic/power_of_two.h"
#include "kernel/query/closest_point.h"
#include "kernel/query/separation.h"

namespace selvage::detail {

namespace {

Vec3 unit(const Double3& direction) {
  return is_zero(direction) ? Vec3::Zero() : to_vec3(scaled(1 / norm(direction), direction));
}

/// The normal of the polygon where the features touch but for rounding, and nothing else says where from.
Double3 direction_or_normal(const Double3& direction, const ClosestPoint<double>& closest) {
  return is_zero(direction) ? closest.plane_normal : direction;
}

/// The direction a little before `tick`, where the gap is wide enough that its bracket shows it to be good.
Double3 approach_direction(const PairMotion<double>& motion, Tick tick) {
  constexpr double kGoodBracket = 1 - 0x1p-20;  // sin(angle) <= sqrt(1 - kGoodBracket^2) = 2^-9.5
  for (const int back : {24, 36, 48, 52}) {
    const Tick earlier = tick > (Tick{1} << back) ? tick - (Tick{1} << back) : 0;
    const auto at = polygon_at_tick(motion, earlier);
    const auto closest = closest_point(motion.kind, at);
    const auto [lower, direction] = supported_distance(motion, at, closest);
    const double upper = gap_upper(motion, earlier, at, closest.weights);
    if (earlier == 0 || lower > kGoodBracket * upper) return direction_or_normal(direction, closest);
  }
  return {};
}

}  // namespace

DifferencePolygon<double> polygon_at_tick(const PairMotion<double>& motion, Tick tick) {
  if (tick == 0) return motion.t0;
  if (tick == kTicks) return motion.t1;
  return polygon_at(motion, time_of(kTicks - tick), time_of(tick));
}

double gap_upper(const PairMotion<double>& motion, Tick tick, const DifferencePolygon<double>& at,
                 const std::array<double, 4>& weights) {
  return distance_upper(motion, at, tick != 0 && tick != kTicks, weights);
}

CcdResult contact_answer(const PlanePassage& passage, int exponent) {
  CcdResult result;
  result.verdict = CcdVerdict::kCollides;
  result.cause = CcdCause::kMotion;
  result.toi_lower = time_of(passage.tick);
  result.gap_bound = times_power_upper(passage.gap, exponent);
  result.weights = passage.weights;
  result.normal = to_vec3(passage.normal);
  result.intervals = passage.intervals;
  return result;
}

void answer_contact(CcdResult& result, const PairMotion<double>& motion, Tick tick) {
  const auto at = polygon_at_tick(motion, tick);
  const auto closest = closest_point(motion.kind, at);
  const double gap = gap_upper(motion, tick, at, closest.weights);
  result.verdict = gap <= kAlarmGap ? CcdVerdict::kCollides : CcdVerdict::kUnresolved;
  result.cause = CcdCause::kMotion;
  result.toi_lower = time_of(tick);
  result.gap_bound = times_power_upper(gap, motion.exponent);
  result.weights = closest.weights;
  result.normal = unit(approach_direction(motion, tick));
}

void answer_end(CcdResult& result, const PairMotion<double>& motion, double tolerance) {
  result.toi_lower = 1;
  result.cause = CcdCause::kNone;
  result.verdict = CcdVerdict::kSeparated;
  if (tolerance == 0) return;  // no touch at t = 1 is a distance above zero
  const auto closest = closest_point(motion.kind, motion.t1);
  const auto [lower, direction] = supported_distance(motion, motion.t1, closest);
  // In the motion's own scale: at the caller's, a subnormal distance would be rounded, and the answer depend on scale.
  if (lower > times_power_upper(tolerance, -motion.exponent)) return;
  result.verdict = CcdVerdict::kCollides;
  result.cause = CcdCause::kEnd;
  result.gap_bound = times_power_upper(gap_upper(motion, kTicks, motion.t1, closest.weights), motion.exponent);
  result.weights = closest.weights;
  result.normal = unit(direction_or_normal(direction, closest));
}

}  // namespace selvage::detail
