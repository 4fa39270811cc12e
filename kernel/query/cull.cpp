#include "kernel/query/cull.h"

#include "kernel/arithmetic/power_of_two.h"
#include "kernel/arithmetic/rounding.h"

namespace selvage::detail {

namespace {

constexpr std::size_t kLanes = 8;

/// Steps of Gilbert's algorithm after the normal. On public cloth candidates the normal at half time separates 63 % of
/// the pairs, the first step 27 %, the next three 6 %, four more 1 %.
constexpr int kCullSteps = 4;

using Lanes = std::array<double, kLanes>;

Lanes project(const SweptCorners& c, const Double3& n) {
  Lanes value;
  for (std::size_t i = 0; i < kLanes; ++i) value[i] = (n.x * c.x[i] + n.y * c.y[i]) + n.z * c.z[i];
  return value;
}

double least(double a, double b, double c, double d) { return std::min(std::min(a, b), std::min(c, d)); }
double greatest(double a, double b, double c, double d) { return std::max(std::max(a, b), std::max(c, d)); }

/// The first lane with this value.
std::size_t lane_of(const Lanes& lanes, double value) {
  std::size_t lane = 0;
  for (std::size_t i = kLanes; i-- > 0;) lane = lanes[i] == value ? i : lane;
  return lane;
}

/// Whether the features are proved farther than the scaled tolerance where n . x >= support for all corners: fewer than
/// 8 roundings. Below 2^-900 the square of |n| may have lost bits.
bool exceeds_tolerance(double support, double error, const Double3& n, double tolerance) {
  const double squared = dot(n, n);
  return squared > 0x1p-900 && (support - error) * (1 - kQuotientError) > tolerance * std::sqrt(squared);
}

Double3 lane_sum(const SweptCorners& c, std::size_t i) {
  return {c.x[i] + c.x[i + 4], c.y[i] + c.y[i + 4], c.z[i] + c.z[i + 4]};
}

}  // namespace

SweptCorners swept_corners(PairKind kind, const CanonicalOrder& order, const Vec3* x_t0, const Vec3* x_t1) {
  SweptCorners corners;
  for (const std::size_t end : {0U, 1U}) {
    const Vec3* x = end == 0 ? x_t0 : x_t1;
    const Vec3 &p0 = x[order.original[0]], &p1 = x[order.original[1]], &p2 = x[order.original[2]];
    const auto put = [&corners, end](std::size_t i, const Vec3& p, const Vec3& q) {
      corners.x[4 * end + i] = p[0] - q[0];
      corners.y[4 * end + i] = p[1] - q[1];
      corners.z[4 * end + i] = p[2] - q[2];
    };
    if (kind == PairKind::kEe) {
      const Vec3& p3 = x[order.original[3]];
      put(0, p0, p2);
      put(1, p0, p3);
      put(2, p1, p2);
      put(3, p1, p3);
    } else {
      const Vec3& last = kind == PairKind::kVf ? x[order.original[3]] : p2;
      put(0, p0, p1);
      put(1, p0, p2);
      put(2, p0, last);
      put(3, p0, last);
    }
  }
  const auto largest_of = [](const Lanes& v) {
    Lanes a;
    for (std::size_t i = 0; i < kLanes; ++i) a[i] = std::fabs(v[i]);
    return std::max(greatest(a[0], a[1], a[2], a[3]), greatest(a[4], a[5], a[6], a[7]));
  };
  corners.extent = {largest_of(corners.x), largest_of(corners.y), largest_of(corners.z)};
  const double largest = max_component(corners.extent);
  corners.exponent = largest > 0 ? exponent_of(largest) : 0;
  const auto scale = [&corners](double factor) {
    for (std::size_t i = 0; i < kLanes; ++i) {
      corners.x[i] *= factor;
      corners.y[i] *= factor;
      corners.z[i] *= factor;
    }
    corners.extent = scaled(factor, corners.extent);
  };
  const int e = -corners.exponent;
  if (e <= 1023) {
    scale(power_of_two(e));
  } else {  // the largest difference is subnormal, and 2^e no double
    scale(power_of_two(e / 2));
    scale(power_of_two(e - e / 2));
  }
  return corners;
}

bool cull(const SweptCorners& corners, double tolerance) {
  const double scaled_tolerance = times_power_upper(tolerance, -corners.exponent);
  const auto error_of = [&corners](const Double3& n) {
    return kSupportError<double> * dot(abs(n), corners.extent) + kUnderflowError;
  };
  const Double3 s0 = lane_sum(corners, 0), s1 = lane_sum(corners, 1), s2 = lane_sum(corners, 2);
  const Double3 normal = cross(s1 - s0, s2 - s0);
  const Lanes v = project(corners, normal);
  const double error = error_of(normal);
  const double low_t0 = least(v[0], v[1], v[2], v[3]), low_t1 = least(v[4], v[5], v[6], v[7]);
  if (std::min(low_t0, low_t1) > error) return exceeds_tolerance(low_t1, error, normal, scaled_tolerance);
  const double high_t0 = greatest(v[0], v[1], v[2], v[3]), high_t1 = greatest(v[4], v[5], v[6], v[7]);
  if (-std::max(high_t0, high_t1) > error) return exceeds_tolerance(-high_t1, error, normal, scaled_tolerance);

  Double3 point = scaled(0.125, (s0 + s1) + (s2 + lane_sum(corners, 3)));
  for (int step = 0; step < kCullSteps; ++step) {
    const Lanes w = project(corners, point);
    const double step_error = error_of(point);
    const double step_low_t1 = least(w[4], w[5], w[6], w[7]);
    const double step_low = std::min(least(w[0], w[1], w[2], w[3]), step_low_t1);
    if (step_low > step_error) return exceeds_tolerance(step_low_t1, step_error, point, scaled_tolerance);
    const std::size_t i = lane_of(w, step_low);
    const Double3 toward = Double3{corners.x[i], corners.y[i], corners.z[i]} - point;
    const double fraction = -dot(point, toward) / dot(toward, toward);
    if (!(fraction > 0)) return false;
    point = point + scaled(std::min(fraction, 1.0), toward);
  }
  return false;
}

}  // namespace selvage::detail
