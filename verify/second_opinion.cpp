#include "verify/second_opinion.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>
#include <vector>

#include <CGAL/Algebraic_kernel_d_1.h>
#include <CGAL/Gmpq.h>
#include <CGAL/Gmpz.h>

#include "verify/fp_guard.h"

namespace selvage::verify {
namespace {

using Kernel = CGAL::Algebraic_kernel_d_1<CGAL::Gmpz>;
using Polynomial = Kernel::Polynomial_1;
using Time = Kernel::Algebraic_real_1;
using Vector = std::array<Polynomial, 3>;

Vector operator-(const Vector& a, const Vector& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Polynomial dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Polynomial norm_squared(const Vector& a) { return dot(a, a); }

/// x_t0 + t (x_t1 - x_t0) for every point, times the common denominator of all coordinates.
template <std::size_t N>
std::array<Vector, N> paths(const std::array<Point, N>& x_t0, const std::array<Point, N>& x_t1) {
  CGAL::Gmpz denominator = 1;  // all denominators are powers of two, so the largest is a common one
  for (const auto* points : {&x_t0, &x_t1}) {
    for (const Point& point : *points) {
      for (const double value : point) {
        if (!std::isfinite(value)) throw std::invalid_argument("exact arithmetic needs finite coordinates");
        denominator = std::max(denominator, CGAL::Gmpq(value).denominator());
      }
    }
  }
  const auto whole = [&denominator](double value) { return (CGAL::Gmpq(value) * denominator).numerator(); };
  std::array<Vector, N> result;
  for (std::size_t i = 0; i < N; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const CGAL::Gmpz first = whole(x_t0[i][k]), last = whole(x_t1[i][k]);
      result[i][k] = Polynomial(first, last - first);
    }
  }
  return result;
}

/// The sign of the polynomial at a time in [0,1].
int sign_at(const Polynomial& polynomial, const Time& t) {
  // Not CGAL's own sign_at_1: in 5.5.1 it refines the time in a loop that fails a precondition where refining happens
  // to find the rational value (SecondOpinion.SurvivesARationalRootFoundLate).
  const Kernel kernel;
  if (kernel.is_zero_at_1_object()(polynomial, t)) return 0;
  // A bound of the derivative on [-1,2], where the approximations are: the sum of i |c_i| 2^(i-1).
  CGAL::Gmpz slope = 0, power = 1;
  for (int i = 1; i <= CGAL::degree(polynomial); ++i, power *= 2)
    slope += CGAL::abs(polynomial[static_cast<unsigned>(i)]) * power * i;
  for (int bits = 16;; bits *= 2) {
    const auto [low, high] = kernel.approximate_absolute_1_object()(t, bits);
    const Kernel::Bound value = polynomial.evaluate(low);
    if (CGAL::abs(value) > slope * (high - low)) return CGAL::sign(value);
  }
}

/// A point and a segment of possibly no length.
class PointOnSegment {
 public:
  PointOnSegment(const Vector& p, const Vector& x, const Vector& y)
      : length_squared_(norm_squared(y - x)),
        distance_squared_(norm_squared(p - x)),
        off_line_(norm_squared(cross(p - x, y - x))),
        along_(dot(p - x, y - x)),
        to_end_(length_squared_ - along_) {}

  [[nodiscard]] bool holds(const Time& t) const {
    if (sign_at(length_squared_, t) == 0) return sign_at(distance_squared_, t) == 0;
    return sign_at(off_line_, t) == 0 && sign_at(along_, t) >= 0 && sign_at(to_end_, t) >= 0;
  }
  /// Polynomials at one of whose roots it begins to hold, unless it holds at t = 0.
  void add_critical(std::vector<Polynomial>& list) const {
    if (!CGAL::is_zero(off_line_)) {
      list.push_back(off_line_);  // zero wherever the condition holds
    } else {
      list.insert(list.end(), {length_squared_, distance_squared_, along_, to_end_});
    }
  }

 private:
  Polynomial length_squared_, distance_squared_, off_line_, along_, to_end_;
};

/// A vertex-face or edge-edge pair: coplanar, and either spanning a plane with all weights >= 0, or a point on a
/// segment.
struct Pair {
  Polynomial coplanarity;
  Polynomial normal_squared;
  std::vector<Polynomial> weights;  ///< times normal_squared
  std::vector<PointOnSegment> degenerate;

  [[nodiscard]] bool touches(const Time& t) const {
    if (sign_at(coplanarity, t) != 0) return false;
    if (sign_at(normal_squared, t) != 0) {
      return std::ranges::all_of(weights, [&](const Polynomial& weight) { return sign_at(weight, t) >= 0; });
    }
    return std::ranges::any_of(degenerate, [&](const PointOnSegment& condition) { return condition.holds(t); });
  }
};

/// 0, 1, and all roots between of the polynomials that are not zero; ascending.
std::vector<Time> critical_times(const std::vector<Polynomial>& polynomials) {
  const Kernel kernel;
  std::vector<Time> times = {Time(0), Time(1)};
  for (const Polynomial& polynomial : polynomials) {
    if (CGAL::is_zero(polynomial) || CGAL::degree(polynomial) == 0) continue;
    std::vector<Time> roots;
    kernel.solve_1_object()(polynomial, false, std::back_inserter(roots));
    std::ranges::copy_if(roots, std::back_inserter(times), [](const Time& t) { return t > Time(0) && t < Time(1); });
  }
  std::sort(times.begin(), times.end());
  return times;
}

/// The set of touching times is closed. REQUIRES that its minimum is 0, 1 or a root of one of the polynomials.
template <class Touches>
SecondOpinion first_touch(const std::vector<Polynomial>& polynomials, const Touches& touches) {
  for (const Time& t : critical_times(polynomials)) {
    if (!touches(t)) continue;
    const auto [low, high] = Kernel().approximate_absolute_1_object()(t, 60);
    return {true, CGAL::to_interval(low).first, CGAL::to_interval(high).second};
  }
  return {};
}

SecondOpinion first_touch(const Pair& pair) {
  // Touching is decided by the weights' signs where the normal is not zero, by the degenerate conditions elsewhere; so
  // it begins at a root of a weight, of the normal, or, where the normal is always zero, of a condition.
  std::vector<Polynomial> polynomials;
  if (!CGAL::is_zero(pair.coplanarity)) {
    polynomials = {pair.coplanarity};
  } else if (!CGAL::is_zero(pair.normal_squared)) {
    polynomials = pair.weights;
    polynomials.push_back(pair.normal_squared);
  } else {
    for (const PointOnSegment& condition : pair.degenerate) condition.add_critical(polynomials);
  }
  return first_touch(polynomials, [&pair](const Time& t) { return pair.touches(t); });
}

}  // namespace

SecondOpinion second_opinion_vf(const std::array<Point, 4>& x_t0, const std::array<Point, 4>& x_t1) {
  const FpGuard guard;
  const auto [p, a, b, c] = paths(x_t0, x_t1);
  const Vector normal = cross(b - a, c - a);
  Pair pair;
  pair.coplanarity = dot(p - a, normal);
  pair.normal_squared = norm_squared(normal);
  pair.weights = {dot(cross(b - p, c - p), normal), dot(cross(c - p, a - p), normal), dot(cross(a - p, b - p), normal)};
  pair.degenerate = {{p, a, b}, {p, b, c}, {p, c, a}};
  return first_touch(pair);
}

SecondOpinion second_opinion_ee(const std::array<Point, 4>& x_t0, const std::array<Point, 4>& x_t1) {
  const FpGuard guard;
  const auto [a, b, c, d] = paths(x_t0, x_t1);
  const Vector normal = cross(b - a, d - c);
  Pair pair;
  pair.coplanarity = dot(c - a, normal);
  pair.normal_squared = norm_squared(normal);
  // Each edge parameter, measured from either end.
  pair.weights = {dot(cross(c - a, d - c), normal), dot(cross(d - c, c - b), normal), dot(cross(c - a, b - a), normal),
                  dot(cross(b - a, d - a), normal)};
  pair.degenerate = {{a, c, d}, {b, c, d}, {c, a, b}, {d, a, b}};
  return first_touch(pair);
}

SecondOpinion second_opinion_self(const std::array<Point, 3>& x_t0, const std::array<Point, 3>& x_t1) {
  const FpGuard guard;
  const auto [p, a, b] = paths(x_t0, x_t1);
  const PointOnSegment condition(p, a, b);
  std::vector<Polynomial> polynomials;
  condition.add_critical(polynomials);
  return first_touch(polynomials, [&condition](const Time& t) { return condition.holds(t); });
}

}  // namespace selvage::verify
