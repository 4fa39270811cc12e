#include "verify/filter/near_filter.h"

#include <algorithm>
#include <cmath>

#include "verify/arithmetic/gaps.h"

namespace selvage::verify {
namespace {

// The distance is at most the length of any r = w_0 D_0 + w_1 D_1 + w_2 D_2, w >= 0, sum w = 1, over the differences D
// of the features' corners (vf: of the face's to p; ee: one weight along each edge). Weights are guesses: any will do.

double clamp(double s) { return s > 0 ? std::min(s, 1.0) : 0.0; }  // NaN gives 0

/// The part of the way from a to b at which the segment is nearest to the origin.
double nearest_to_origin(const Point& a, const Point& b) {
  const Point edge = difference(b, a);
  return clamp(-dot(a, edge) / dot(edge, edge));
}

Point between(const Point& a, const Point& b, double s) {
  const double rest = 1 - s;
  return {rest * a[0] + s * b[0], rest * a[1] + s * b[1], rest * a[2] + s * b[2]};
}

double largest(const std::array<Point, 3>& points) {
  double most = 0;
  for (const Point& point : points) {
    for (const double coordinate : point) most = std::max(most, std::abs(coordinate));
  }
  return most;
}

/// |r| <= d, where r was computed from three differences of magnitude m at most.
/// A coordinate: a difference carries one rounding, u m. between() adds the rounding of 1 - s, of the products
/// (together at most u m, as the weights add up to 1) and of the sum: 3 u m. Two of them nested, or the difference of
/// two, are off by at most 4 u m + 4 u m + 2 u m, below 16 u m. The length then errs by sqrt(3) 16 u m < 2^-48 m, and
/// 2^-49 of itself pays for the roundings of the norm, of the sum and of the comparison. 2^-500 covers underflow.
bool is_within(const Point& r, double m, double d) {
  const double length_upper = std::sqrt(dot(r, r)) + 0x1p-48 * m + 0x1p-500;
  return length_upper * (1 + 0x1p-49) <= d;
}

}  // namespace

bool triage_vf_nearer(const std::array<Point, 4>& x, double d) {
  const std::array<Point, 3> corners = {difference(x[1], x[0]), difference(x[2], x[0]), difference(x[3], x[0])};
  const double m = largest(corners);
  if (!(m <= 0x1p+1000)) return false;
  const Point u = difference(corners[1], corners[0]), v = difference(corners[2], corners[0]), n = cross(u, v);
  const double n_squared = dot(n, n);
  const double v_share = dot(n, cross(corners[0], corners[1])) / n_squared;
  const double u_share = dot(n, cross(corners[2], corners[0])) / n_squared;
  if (u_share >= 0 && v_share >= 0 && u_share + v_share <= 1) {
    // Along (a, b) first, then towards c: two nested combinations.
    const double along = clamp(u_share / (1 - v_share));
    if (is_within(between(between(corners[0], corners[1], along), corners[2], v_share), m, d)) return true;
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const Point &a = corners[i], &b = corners[(i + 1) % 3];
    if (is_within(between(a, b, nearest_to_origin(a, b)), m, d)) return true;
  }
  return false;
}

bool triage_ee_nearer(const std::array<Point, 4>& x, double d) {
  const std::array<Point, 3> corners = {difference(x[1], x[0]), difference(x[2], x[0]), difference(x[3], x[0])};
  const double m = largest(corners);
  if (!(m <= 0x1p+1000)) return false;
  const Point origin{}, &u = corners[0], &c = corners[1];
  const Point v = difference(corners[2], c), n = cross(u, v);
  // The feet of the common perpendicular, then alternating projections, which mend what clamping spoiled.
  const double foot = clamp(dot(cross(c, v), n) / dot(n, n));
  double s = foot, t = 0;
  for (int i = 0; i < 2; ++i) {
    const Point on_first = between(origin, u, s);
    t = nearest_to_origin(difference(c, on_first), difference(corners[2], on_first));
    const Point on_second = between(c, corners[2], t);
    s = nearest_to_origin(difference(origin, on_second), difference(u, on_second));
  }
  const Point on_first = between(origin, u, s), on_second = between(c, corners[2], t);
  return is_within(difference(on_second, on_first), m, d);
}

}  // namespace selvage::verify
