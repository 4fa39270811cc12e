#include "verify/decision/exact_distance.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <gmpxx.h>

#include "verify/arithmetic/dyadic.h"

namespace selvage::verify {
namespace {

using IntegerVector = std::array<mpz_class, 3>;

IntegerVector operator-(const IntegerVector& a, const IntegerVector& b) {
  return {mpz_class(a[0] - b[0]), mpz_class(a[1] - b[1]), mpz_class(a[2] - b[2])};
}
mpz_class exact_dot(const IntegerVector& a, const IntegerVector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
IntegerVector exact_cross(const IntegerVector& a, const IntegerVector& b) {
  return {mpz_class(a[1] * b[2] - a[2] * b[1]), mpz_class(a[2] * b[0] - a[0] * b[2]),
          mpz_class(a[0] * b[1] - a[1] * b[0])};
}

/// A squared distance; the denominator is positive.
struct Fraction {
  mpz_class numerator, denominator;

  friend bool operator<(const Fraction& a, const Fraction& b) {
    return a.numerator * b.denominator < b.numerator * a.denominator;
  }
};

Fraction squared(const IntegerVector& p, const IntegerVector& q) {
  const IntegerVector d = p - q;
  return {exact_dot(d, d), 1};
}

Fraction squared_point_segment(const IntegerVector& p, const IntegerVector& a, const IntegerVector& b) {
  const IntegerVector edge = b - a, offset = p - a;
  const mpz_class along = exact_dot(edge, offset), length_squared = exact_dot(edge, edge);
  if (along <= 0) return squared(p, a);  // also where the edge has no length
  if (along >= length_squared) return squared(p, b);
  return {exact_dot(offset, offset) * length_squared - along * along, length_squared};
}

using IntegerVectors = std::array<IntegerVector, 4>;

Fraction squared_vf(const IntegerVectors& x) {
  const auto& [p, a, b, c] = x;
  Fraction least =
      std::min({squared_point_segment(p, a, b), squared_point_segment(p, b, c), squared_point_segment(p, c, a)});
  const IntegerVector n = exact_cross(b - a, c - a);
  const mpz_class n_squared = exact_dot(n, n);
  if (n_squared == 0) return least;  // zero area: the triangle is its edges
  const auto inside = [&, &p = p](const IntegerVector& from, const IntegerVector& to) {
    return exact_dot(n, exact_cross(to - from, p - from)) >= 0;
  };
  if (!(inside(a, b) && inside(b, c) && inside(c, a))) return least;
  const mpz_class height = exact_dot(n, p - a);
  return std::min(least, Fraction{height * height, n_squared});
}

Fraction squared_ee(const IntegerVectors& x) {
  const auto& [a, b, c, d] = x;
  Fraction least = std::min({squared_point_segment(a, c, d), squared_point_segment(b, c, d),
                             squared_point_segment(c, a, b), squared_point_segment(d, a, b)});
  // The feet of the common perpendicular of the two lines, a + (u_foot / n_squared)(b - a) and c + ... (d - c).
  const IntegerVector u = b - a, v = d - c, w = a - c, n = exact_cross(u, v);
  const mpz_class n_squared = exact_dot(n, n);
  if (n_squared == 0) return least;  // parallel, or an edge without length: some end point is nearest
  const mpz_class uu = exact_dot(u, u), uv = exact_dot(u, v), vv = exact_dot(v, v), uw = exact_dot(u, w),
                  vw = exact_dot(v, w);
  const mpz_class u_foot = uv * vw - vv * uw, v_foot = uu * vw - uv * uw;
  if (!(u_foot >= 0 && u_foot <= n_squared && v_foot >= 0 && v_foot <= n_squared)) return least;
  const mpz_class gap = exact_dot(w, n);
  return std::min(least, Fraction{gap * gap, n_squared});
}

/// Everything times one power of two: four points and the square of the distance to compare with.
struct Scene {
  IntegerVectors x;
  mpz_class distance_squared;
};

int compare_with_distance(const Fraction& squared, const Scene& s) {
  return cmp(squared.numerator, s.distance_squared * squared.denominator);
}
int compare_vf(const Scene& s) { return compare_with_distance(squared_vf(s.x), s); }
int compare_ee(const Scene& s) { return compare_with_distance(squared_ee(s.x), s); }

void require_distance(double d) {
  if (!(d >= 0) || !std::isfinite(d)) throw std::invalid_argument("a distance must be finite and not negative");
}

Scene scene(const std::array<Point, 4>& x, double d) {
  require_distance(d);
  std::array<double, 13> values{};
  std::array<mpz_class, 13> integers;
  for (std::size_t i = 0; i < 12; ++i) values[i] = x[i / 3][i % 3];
  values[12] = d;
  scale_to_integers(values, integers);
  Scene s;
  for (std::size_t i = 0; i < 12; ++i) s.x[i / 3][i % 3] = std::move(integers[i]);
  s.distance_squared = integers[12] * integers[12];
  return s;
}

/// At t = m / 2^k the points are ((2^k - m) x_t0 + m x_t1) / 2^k: the scene times 2^k is whole again.
Scene scene_at(const std::array<Point, 4>& x_t0, const std::array<Point, 4>& x_t1, double t, double d) {
  require_distance(d);
  if (!(t >= 0 && t <= 1)) throw std::invalid_argument("a time must be in [0,1]");
  std::array<double, 25> values{};
  std::array<mpz_class, 25> integers;
  for (std::size_t i = 0; i < 12; ++i) {
    values[i] = x_t0[i / 3][i % 3];
    values[12 + i] = x_t1[i / 3][i % 3];
  }
  values[24] = d;
  scale_to_integers(values, integers);
  const Dyadic time = to_dyadic(t);  // t <= 1, so with an odd mantissa the exponent is not positive
  const mpz_class whole = mpz_class(1) << static_cast<unsigned long>(-time.exponent);
  const mpz_class later = static_cast<long>(time.mantissa), earlier = whole - later;
  Scene s;
  for (std::size_t i = 0; i < 12; ++i) s.x[i / 3][i % 3] = earlier * integers[i] + later * integers[12 + i];
  const mpz_class distance = integers[24] * whole;
  s.distance_squared = distance * distance;
  return s;
}

}  // namespace

int compare_vf_distance(const std::array<Point, 4>& x, double d) { return compare_vf(scene(x, d)); }
int compare_ee_distance(const std::array<Point, 4>& x, double d) { return compare_ee(scene(x, d)); }

int compare_distances(const FeaturePair& a, const FeaturePair& b) {
  std::array<double, 24> values{};
  std::array<mpz_class, 24> integers;
  for (std::size_t i = 0; i < 12; ++i) {
    values[i] = a.x[i / 3][i % 3];
    values[12 + i] = b.x[i / 3][i % 3];
  }
  scale_to_integers(values, integers);
  IntegerVectors of_a, of_b;
  for (std::size_t i = 0; i < 12; ++i) {
    of_a[i / 3][i % 3] = std::move(integers[i]);
    of_b[i / 3][i % 3] = std::move(integers[12 + i]);
  }
  const Fraction x = a.is_vf ? squared_vf(of_a) : squared_ee(of_a), y = b.is_vf ? squared_vf(of_b) : squared_ee(of_b);
  return x < y ? -1 : (y < x ? 1 : 0);
}

bool vf_within_at(const std::array<Point, 4>& x_t0, const std::array<Point, 4>& x_t1, double t, double d) {
  return compare_vf(scene_at(x_t0, x_t1, t, d)) <= 0;
}
bool ee_within_at(const std::array<Point, 4>& x_t0, const std::array<Point, 4>& x_t1, double t, double d) {
  return compare_ee(scene_at(x_t0, x_t1, t, d)) <= 0;
}

}  // namespace selvage::verify
