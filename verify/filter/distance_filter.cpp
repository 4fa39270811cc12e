#include "verify/filter/distance_filter.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "verify/arithmetic/gaps.h"

namespace selvage::verify {
namespace {

/// a + s (b - a)
Point along(const Point& a, const Point& b, double s) {
  return {a[0] + s * (b[0] - a[0]), a[1] + s * (b[1] - a[1]), a[2] + s * (b[2] - a[2])};
}

/// Only guesses at the nearest points follow: whichever direction they give, gaps() judges it.
Point nearest_on_segment(const Point& p, const Point& a, const Point& b) {
  const Point edge = difference(b, a);
  const double s = dot(difference(p, a), edge) / dot(edge, edge);
  return along(a, b, s > 0 ? std::min(s, 1.0) : 0.0);
}

double distance_squared(const Point& p, const Point& q) {
  const Point d = difference(p, q);
  return dot(d, d);
}

Point from_nearest_on_triangle(const Point& p, const Point& a, const Point& b, const Point& c) {
  const Point n = cross(difference(b, a), difference(c, a));
  const auto inside = [&](const Point& from, const Point& to) {
    return dot(n, cross(difference(to, from), difference(p, from))) > 0;
  };
  if (inside(a, b) && inside(b, c) && inside(c, a)) {
    return dot(n, difference(p, a)) < 0 ? Point{-n[0], -n[1], -n[2]} : n;
  }
  const std::array<Point, 3> candidates = {nearest_on_segment(p, a, b), nearest_on_segment(p, b, c),
                                           nearest_on_segment(p, c, a)};
  const Point nearest = *std::min_element(candidates.begin(), candidates.end(), [&](const Point& x, const Point& y) {
    return distance_squared(p, x) < distance_squared(p, y);
  });
  return difference(p, nearest);
}

/// Alternating projection from the feet of the common perpendicular.
Point between_nearest_on_edges(const Point& a, const Point& b, const Point& c, const Point& d) {
  const Point u = difference(b, a), v = difference(d, c), w = difference(a, c);
  const double uu = dot(u, u), uv = dot(u, v), vv = dot(v, v), determinant = uu * vv - uv * uv;
  const double s = (uv * dot(v, w) - vv * dot(u, w)) / determinant;
  Point on_first = along(a, b, s > 0 ? std::min(s, 1.0) : 0.0);  // parallel: NaN or infinity gives an end
  const Point on_second = nearest_on_segment(on_first, c, d);
  on_first = nearest_on_segment(on_second, a, b);
  return difference(on_first, nearest_on_segment(on_first, c, d));
}

/// gap > d |u|. The length of u errs by less than gamma(4) of itself, and underflow by 2^-500 at most; 2^-49 covers the
/// first, the product and the comparison.
bool exceeds(double gap, const Point& u, double d) {
  const double length_upper = std::sqrt(dot(u, u) + 0x1p-1000) * (1 + 0x1p-49);
  return gap > d * length_upper * (1 + 0x1p-49) + 0x1p-1070;
}

/// The gap along u as a length; 0 where there is none.
double estimate(double gap, const Point& u) {
  const double length = std::sqrt(dot(u, u));
  const double distance = std::min(gap / length, std::numeric_limits<double>::max());
  return distance > 0 ? distance : 0;  // also where it is not a number
}

}  // namespace

bool triage_vf_farther(const std::array<Point, 4>& x, double d) {
  const Point u = from_nearest_on_triangle(x[0], x[1], x[2], x[3]);
  return exceeds(gaps(u, Local<1>(x[0], {x[0]}), Local<3>(x[0], {x[1], x[2], x[3]})).forward, u, d);
}

bool triage_ee_farther(const std::array<Point, 4>& x, double d) {
  const Point u = between_nearest_on_edges(x[0], x[1], x[2], x[3]);
  return exceeds(gaps(u, Local<2>(x[0], {x[0], x[1]}), Local<2>(x[0], {x[2], x[3]})).forward, u, d);
}

double estimate_vf_distance(const std::array<Point, 4>& x) {
  const Point u = from_nearest_on_triangle(x[0], x[1], x[2], x[3]);
  return estimate(gaps(u, Local<1>(x[0], {x[0]}), Local<3>(x[0], {x[1], x[2], x[3]})).forward, u);
}

double estimate_ee_distance(const std::array<Point, 4>& x) {
  const Point u = between_nearest_on_edges(x[0], x[1], x[2], x[3]);
  return estimate(gaps(u, Local<2>(x[0], {x[0], x[1]}), Local<2>(x[0], {x[2], x[3]})).forward, u);
}

}  // namespace selvage::verify
