#include "verify/exact_motion.h"

#include <stdexcept>
#include <utility>

#include "verify/contact.h"
#include "verify/dyadic.h"

namespace selvage::verify {
namespace {

/// The paths in whole numbers: a common power of two scales all coordinates and changes no contact.
template <std::size_t N>
std::array<MovingPoint, N> moving_points(const std::array<Point, N>& x_t0, const std::array<Point, N>& x_t1) {
  std::array<double, 6 * N> values{};
  std::array<mpz_class, 6 * N> integers;
  for (std::size_t i = 0; i < N; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      values[6 * i + 2 * k] = x_t0[i][k];
      values[6 * i + 2 * k + 1] = x_t1[i][k];
    }
  }
  scale_to_integers(values, integers);
  std::array<MovingPoint, N> points;
  for (std::size_t i = 0; i < N; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      points[i][k].degree = 1;
      points[i][k].c[0] = std::move(integers[6 * i + 2 * k]);
      points[i][k].c[1] = std::move(integers[6 * i + 2 * k + 1]);
    }
  }
  return points;
}

constexpr unsigned long kLog2MaxWidth = 60;  // ExactTime's width is at most 2^-60

ExactTime exact_time(Instant instant) {
  while (!instant.is_dyadic() && instant.log2_denominator() < kLog2MaxWidth) instant.refine();
  const unsigned long scale = instant.log2_denominator();
  const mpz_class& low = instant.numerator();
  const mpz_class high = instant.is_dyadic() ? low : low + 1;
  const auto text = [scale](const mpz_class& numerator) {
    mpq_class value(numerator, mpz_class(1) << scale);
    value.canonicalize();
    return value.get_str();
  };
  return {text(low), text(high), round_down(low, scale), round_up(high, scale)};
}

MotionAnswer answer(std::optional<FirstTouch> touch, Detail detail) {
  MotionAnswer answer;
  answer.exact_used = true;
  if (!touch) return answer;
  answer.touches = true;
  answer.kind = touch->is_cross ? MotionKind::kCross : MotionKind::kTouch;
  if (detail == Detail::kFirstTime) answer.first = exact_time(std::move(touch->instant));
  return answer;
}

/// The instant against any finite double.
int compare_with_double(Instant& instant, double t) {
  if (!(t >= 0)) return 1;
  if (t > 1) return -1;
  const Dyadic dyadic = to_dyadic(t);
  mpz_class numerator = static_cast<long>(dyadic.mantissa);
  if (dyadic.exponent > 0) numerator <<= static_cast<unsigned long>(dyadic.exponent);
  Instant other = Instant::dyadic(numerator, dyadic.exponent < 0 ? static_cast<unsigned long>(-dyadic.exponent) : 0);
  return compare(instant, other);
}

}  // namespace

MotionAnswer exact_vf_motion(const std::array<Point, 4>& x_t0, const std::array<Point, 4>& x_t1, Detail detail) {
  return answer(first_vf_touch(moving_points(x_t0, x_t1)), detail);
}

MotionAnswer exact_ee_motion(const std::array<Point, 4>& x_t0, const std::array<Point, 4>& x_t1, Detail detail) {
  return answer(first_ee_touch(moving_points(x_t0, x_t1)), detail);
}

MotionAnswer exact_self_motion(const std::array<Point, 3>& x_t0, const std::array<Point, 3>& x_t1, Detail detail) {
  return answer(first_self_touch(moving_points(x_t0, x_t1)), detail);
}

int compare_first_touch(const std::array<Point, 4>& x_t0, const std::array<Point, 4>& x_t1, bool is_vf, double t) {
  if (t != t) throw std::invalid_argument("compare_first_touch: t is not a number");
  const auto points = moving_points(x_t0, x_t1);
  std::optional<FirstTouch> touch = is_vf ? first_vf_touch(points) : first_ee_touch(points);
  return touch ? compare_with_double(touch->instant, t) : 1;
}

}  // namespace selvage::verify
