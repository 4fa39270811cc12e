#include "bench/textbook.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace selvage::bench {
namespace {

// x4 is close to the triangle (x1, x2, x3): near its plane, with barycentric coordinates within [-delta, 1 + delta],
// delta = tolerance / characteristic length. A zero-area triangle has no normal, and the method no answer for it.
bool point_near_triangle(const std::array<Vec3, 4>& x, double tolerance) {
  const Vec3 x13 = x[1] - x[3];
  const Vec3 x23 = x[2] - x[3];
  const Vec3 x43 = x[0] - x[3];
  const Vec3 normal = x13.cross(x23);
  const double height = x43.dot(normal), four_area_squared = normal.squaredNorm();
  if (four_area_squared == 0 || height * height > tolerance * tolerance * four_area_squared) return false;
  const double twice_area = std::sqrt(four_area_squared);
  const double a11 = x13.squaredNorm();
  const double a12 = x13.dot(x23);
  const double a22 = x23.squaredNorm();
  const double b1 = x13.dot(x43);
  const double b2 = x23.dot(x43);
  const double determinant = a11 * a22 - a12 * a12;
  if (determinant == 0) return false;
  const double w1 = (a22 * b1 - a12 * b2) / determinant;
  const double w2 = (a11 * b2 - a12 * b1) / determinant;
  const double w3 = 1 - w1 - w2;
  const double delta = tolerance / std::sqrt(twice_area);
  const auto inside = [delta](double w) { return w >= -delta && w <= 1 + delta; };
  return inside(w1) && inside(w2) && inside(w3);
}

double clamp_unit(double a) { return std::clamp(a, 0.0, 1.0); }

// Closest points of the edges (x1, x2) and (x3, x4): the normal equations of the infinite lines, then clamping, where
// the point that moved the most is right and the other one is projected again.
bool edges_near(const std::array<Vec3, 4>& x, double tolerance) {
  const Vec3 x21 = x[1] - x[0];
  const Vec3 x43 = x[3] - x[2];
  const Vec3 x31 = x[2] - x[0];
  // Lines that are farther apart than this decide most pairs. Where they are parallel both sides are zero.
  const Vec3 normal = x21.cross(x43);
  const double height = x31.dot(normal);
  if (height * height > tolerance * tolerance * normal.squaredNorm()) return false;
  const double a11 = x21.squaredNorm();
  const double a12 = -x21.dot(x43);
  const double a22 = x43.squaredNorm();
  const double b1 = x21.dot(x31);
  const double b2 = -x43.dot(x31);
  const double determinant = a11 * a22 - a12 * a12;
  double a = 0;
  double b = 0;
  constexpr double kParallel =
      1e-14;  // sine squared below which the edges count as parallel: round-off of the products
  if (determinant > kParallel * a11 * a22) {
    a = (a22 * b1 - a12 * b2) / determinant;
    b = (a11 * b2 - a12 * b1) / determinant;
    const double moved_a = std::abs(a - clamp_unit(a)) * std::sqrt(a11);
    const double moved_b = std::abs(b - clamp_unit(b)) * std::sqrt(a22);
    if (moved_a > moved_b) {
      a = clamp_unit(a);
      b = clamp_unit((b2 - a12 * a) / a22);
    } else if (moved_b > 0) {
      b = clamp_unit(b);
      a = clamp_unit((b1 - a12 * b) / a11);
    }
  } else if (a11 > 0 && a22 > 0) {
    // One dimension: where the projections overlap the lines' distance counts, else the nearest ends.
    const double c = b1 / a11;       // of x3 along the first edge
    const double d = c - a12 / a11;  // of x4
    a = clamp_unit((std::max(0.0, std::min(c, d)) + std::min(1.0, std::max(c, d))) / 2);
    b = clamp_unit((b2 - a12 * a) / a22);
    a = clamp_unit((b1 - a12 * b) / a11);
  } else if (a11 > 0) {
    a = clamp_unit(b1 / a11);
  } else if (a22 > 0) {
    b = clamp_unit(b2 / a22);
  }
  const Vec3 apart = x31 + b * x43 - a * x21;
  return apart.squaredNorm() < tolerance * tolerance;
}

struct Cubic {
  double k0, k1, k2, k3;
  [[nodiscard]] double at(double t) const { return ((k3 * t + k2) * t + k1) * t + k0; }
  [[nodiscard]] double slope(double t) const { return (3 * k3 * t + 2 * k2) * t + k1; }
};

/// (e1 + t w1) x (e2 + t w2) . (r + t v)
Cubic coplanarity(const Vec3& e1, const Vec3& w1, const Vec3& e2, const Vec3& w2, const Vec3& r, const Vec3& v) {
  const Vec3 n0 = e1.cross(e2);
  const Vec3 n1 = w1.cross(e2) + e1.cross(w2);
  const Vec3 n2 = w1.cross(w2);
  return {n0.dot(r), n1.dot(r) + n0.dot(v), n2.dot(r) + n1.dot(v), n2.dot(v)};
}

/// The root in [low, high], whose values have opposite signs: Newton's method, bisecting where it leaves the bracket.
double root_between(const Cubic& f, double low, double high, bool rising) {
  double t = low + (high - low) / 2;
  constexpr int kMaxSteps = 60;  // bisection alone reaches the spacing of doubles in [0,1] in 53
  for (int step = 0; step < kMaxSteps; ++step) {
    const double value = f.at(t);
    if (value == 0) break;
    ((value > 0) == rising ? high : low) = t;
    const double slope = f.slope(t);
    double next = t - value / slope;
    if (!(next > low && next < high)) next = low + (high - low) / 2;
    if (std::abs(next - t) <= 0x1p-53) break;
    t = next;
  }
  return t;
}

/// The ends of the pieces of [0,1] on which f is monotone, in increasing order. Returns how many.
int monotone_ends(const Cubic& f, std::array<double, 4>& ends) {
  ends[0] = 0;
  int count = 1;
  const double discriminant = f.k2 * f.k2 - 3 * f.k3 * f.k1;
  if (discriminant > 0) {
    const double q = -(f.k2 + std::copysign(std::sqrt(discriminant), f.k2));
    double first = q / (3 * f.k3);  // infinite where f is a parabola
    double second = f.k1 / q;
    if (first > second) std::swap(first, second);
    if (first > 0 && first < 1) ends[static_cast<std::size_t>(count++)] = first;
    if (second > 0 && second < 1) ends[static_cast<std::size_t>(count++)] = second;
  }
  ends[static_cast<std::size_t>(count++)] = 1;
  return count;
}

/// No root in [0,1]: the coefficients in Bernstein's basis have one sign. Decides most pairs without a division.
bool has_one_sign(const Cubic& f) {
  const double b0 = 3 * f.k0, b1 = b0 + f.k1, b2 = b1 + f.k1 + f.k2, b3 = f.at(1);
  return (b0 > 0 && b1 > 0 && b2 > 0 && b3 > 0) || (b0 < 0 && b1 < 0 && b2 < 0 && b3 < 0);
}

template <typename NearTest>
TextbookAnswer first_close_root(const Cubic& f, const std::array<Vec3, 4>& x_t0, const std::array<Vec3, 4>& x_t1,
                                double tolerance, NearTest near) {
  const auto near_at = [&](double t) {
    std::array<Vec3, 4> x;
    for (std::size_t i = 0; i < 4; ++i) x[i] = x_t0[i] + t * (x_t1[i] - x_t0[i]);
    return near(x, tolerance);
  };
  if (has_one_sign(f)) return {near(x_t1, tolerance), 1};
  std::array<double, 4> ends{};
  const int count = monotone_ends(f, ends);
  double low = f.at(0);
  if (low == 0 && near(x_t0, tolerance)) return {true, 0};
  for (int i = 1; i < count; ++i) {
    const double end = ends[static_cast<std::size_t>(i)];
    const double high = f.at(end);
    if (high == 0) {
      if (near_at(end)) return {true, end};
    } else if ((low < 0 && high > 0) || (low > 0 && high < 0)) {
      const double root = root_between(f, ends[static_cast<std::size_t>(i) - 1], end, high > 0);
      if (near_at(root)) return {true, root};
    }
    low = high;
  }
  return {near(x_t1, tolerance), 1};
}

}  // namespace

TextbookAnswer textbook_vf(const std::array<Vec3, 4>& x_t0, const std::array<Vec3, 4>& x_t1, double tolerance) {
  std::array<Vec3, 4> v;
  for (std::size_t i = 0; i < 4; ++i) v[i] = x_t1[i] - x_t0[i];
  const Cubic f =
      coplanarity(x_t0[2] - x_t0[1], v[2] - v[1], x_t0[3] - x_t0[1], v[3] - v[1], x_t0[0] - x_t0[1], v[0] - v[1]);
  return first_close_root(f, x_t0, x_t1, tolerance, point_near_triangle);
}

TextbookAnswer textbook_ee(const std::array<Vec3, 4>& x_t0, const std::array<Vec3, 4>& x_t1, double tolerance) {
  std::array<Vec3, 4> v;
  for (std::size_t i = 0; i < 4; ++i) v[i] = x_t1[i] - x_t0[i];
  const Cubic f =
      coplanarity(x_t0[1] - x_t0[0], v[1] - v[0], x_t0[3] - x_t0[2], v[3] - v[2], x_t0[2] - x_t0[0], v[2] - v[0]);
  return first_close_root(f, x_t0, x_t1, tolerance, edges_near);
}

}  // namespace selvage::bench
