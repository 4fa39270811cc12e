#include "verify/decision/exact_motion.h"

#include <cmath>
#include <stdexcept>
#include <utility>

#include "verify/arithmetic/dyadic.h"
#include "verify/arithmetic/fp_guard.h"
#include "verify/decision/contact.h"
#include "verify/filter/motion_filter.h"

namespace selvage::verify {
namespace {

MotionAnswer exact_answer(std::optional<FirstTouch> touch, Detail detail) {
  MotionAnswer answer;
  answer.exact_used = true;
  if (!touch) return answer;
  answer.touches = true;
  answer.kind = touch->is_cross ? MotionKind::kCross : MotionKind::kTouch;
  if (detail == Detail::kFirstTime) answer.first = exact_time(std::move(touch->instant));
  return answer;
}

/// The filter's answer where it suffices.
template <std::size_t N, class Triage, class Exact>
MotionAnswer decide(const std::array<Point, N>& x_t0, const std::array<Point, N>& x_t1, Detail detail,
                    const Triage& triage_motion, const Exact& first_touch) {
  require_finite(x_t0, "exact motion");
  require_finite(x_t1, "exact motion");
  const FpGuard guard;
  const MotionTriage triage = triage_motion(x_t0, x_t1);
  if (triage == MotionTriage::kApart) return {};
  if (triage == MotionTriage::kCrosses && detail == Detail::kDecision) return {true, MotionKind::kCross, {}, false};
  return exact_answer(first_touch(moving_points(x_t0, x_t1)), detail);
}

/// The instant against any double.
int compare_with_double(Instant& instant, double t) {
  if (!(t >= 0)) return 1;
  if (t > 1) return -1;
  const Dyadic dyadic = to_dyadic(t);
  const mpz_class numerator = static_cast<long>(dyadic.mantissa);
  Instant other = Instant::dyadic(numerator, static_cast<unsigned long>(-dyadic.exponent));
  return compare(instant, other);
}

template <std::size_t N, class Triage, class Exact>
MotionAgainst decide_against(const std::array<Point, N>& x_t0, const std::array<Point, N>& x_t1, double t,
                             const Triage& triage_motion, const Exact& first_touch) {
  if (!std::isfinite(t)) throw std::invalid_argument("exact motion: a time must be finite");
  require_finite(x_t0, "exact motion");
  require_finite(x_t1, "exact motion");
  const FpGuard guard;
  const MotionTriage triage = triage_motion(x_t0, x_t1);
  if (triage == MotionTriage::kApart) return {};
  if (triage == MotionTriage::kCrosses && (t <= 0 || t >= 1)) return {true, t <= 0 ? 1 : -1, false};  // inside (0,1)
  std::optional<FirstTouch> touch = first_touch(moving_points(x_t0, x_t1));
  if (!touch) return {false, 1, true};
  return {true, compare_with_double(touch->instant, t), true};
}

}  // namespace

MotionAnswer exact_vf_motion(const std::array<Point, 4>& x_t0, const std::array<Point, 4>& x_t1, Detail detail) {
  return decide(x_t0, x_t1, detail, triage_vf_motion, [](const auto& x) { return first_vf_touch(x); });
}

MotionAnswer exact_ee_motion(const std::array<Point, 4>& x_t0, const std::array<Point, 4>& x_t1, Detail detail) {
  return decide(x_t0, x_t1, detail, triage_ee_motion, [](const auto& x) { return first_ee_touch(x); });
}

MotionAnswer exact_self_motion(const std::array<Point, 3>& x_t0, const std::array<Point, 3>& x_t1, Detail detail) {
  return decide(x_t0, x_t1, detail, triage_self_motion, [](const auto& x) { return first_self_touch(x); });
}

MotionAgainst vf_motion_against(const std::array<Point, 4>& x_t0, const std::array<Point, 4>& x_t1, double t) {
  return decide_against(x_t0, x_t1, t, triage_vf_motion, [](const auto& x) { return first_vf_touch(x); });
}

MotionAgainst ee_motion_against(const std::array<Point, 4>& x_t0, const std::array<Point, 4>& x_t1, double t) {
  return decide_against(x_t0, x_t1, t, triage_ee_motion, [](const auto& x) { return first_ee_touch(x); });
}

MotionAgainst self_motion_against(const std::array<Point, 3>& x_t0, const std::array<Point, 3>& x_t1, double t) {
  return decide_against(x_t0, x_t1, t, triage_self_motion, [](const auto& x) { return first_self_touch(x); });
}

int compare_first_touch(const std::array<Point, 4>& x_t0, const std::array<Point, 4>& x_t1, bool is_vf, double t) {
  if (t != t) throw std::invalid_argument("compare_first_touch: t is not a number");
  const FpGuard guard;
  const auto points = moving_points(x_t0, x_t1);
  std::optional<FirstTouch> touch = is_vf ? first_vf_touch(points) : first_ee_touch(points);
  return touch ? compare_with_double(touch->instant, t) : 1;
}

}  // namespace selvage::verify
