#include "verify/decision/second_opinion.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <stdexcept>
#include <utility>
#include <vector>

// clang-format off: before all else of CGAL
#include "verify/decision/cgal_fpu.h"
// clang-format on

#include <CGAL/Algebraic_kernel_d_1.h>
#include <CGAL/Gmpq.h>
#include <CGAL/Gmpz.h>
#include <CGAL/Interval_nt.h>

#include "verify/arithmetic/fp_guard.h"

namespace selvage::verify {
namespace {

/// CGAL's interval arithmetic needs directed rounding, of the compiler's flags (-frounding-math) as of the processor.
/// Throws std::runtime_error where there is none. CGAL asserts the same while a program starts: under valgrind, which
/// rounds to nearest only, that ends all that is linked with the checker, whether it asks for a second opinion or not.
/// So CGAL's check is off (CMakeLists.txt), and this one stands where intervals may be used.
void require_directed_rounding() {
  const CGAL::Interval_nt<> inexact = CGAL::Interval_nt<>(1.1) * CGAL::Interval_nt<>(10.1);
  if (inexact.is_point()) {
    throw std::runtime_error(
        "second opinions need directed rounding, which there is not here (valgrind, for one, rounds to nearest only): "
        "ask for none, or elsewhere");
  }
}

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

Polynomial primitive(const Polynomial& p) { return CGAL::is_zero(p) ? p : Polynomial(p / p.content()); }

/// Up to a constant factor, by pseudo-remainders: for these degrees ten times faster than CGAL's modular algorithm.
Polynomial common_divisor(Polynomial a, Polynomial b) {
  while (!CGAL::is_zero(b)) {
    a = primitive(CGAL::degree(a) < CGAL::degree(b) ? a : CGAL::pseudo_division_remainder(a, b));
    std::swap(a, b);
  }
  return primitive(a);
}

int sign_at_start(const Polynomial& p) { return CGAL::sign(p[0]); }
int sign_at_end(const Polynomial& p) { return CGAL::sign(std::accumulate(p.begin(), p.end(), CGAL::Gmpz(0))); }

/// The sign of the polynomial at a time in [0,1].
int sign_at(const Polynomial& polynomial, const Time& t) {
  if (CGAL::is_zero(polynomial)) return 0;
  if (t.is_rational()) {
    const CGAL::Gmpq rational = t.rational();
    if (rational == 0) return sign_at_start(polynomial);
    return rational == 1 ? sign_at_end(polynomial) : polynomial.sign_at(rational);
  }
  // Not CGAL's own sign_at_1: in 5.5.1 it refines the time in a loop that fails a precondition where refining happens
  // to find the rational value (SecondOpinion.SurvivesARationalRootFoundLate).
  const Kernel kernel;
  // A bound of the derivative on [-1,2], where the approximations are: the sum of i |c_i| 2^(i-1).
  CGAL::Gmpz slope = 0, power = 1;
  for (int i = 1; i <= CGAL::degree(polynomial); ++i, power *= 2)
    slope += CGAL::abs(polynomial[static_cast<unsigned>(i)]) * power * i;
  constexpr int kFirstBits = 16;
  for (int bits = kFirstBits;; bits *= 2) {
    const auto [low, high] = kernel.approximate_absolute_1_object()(t, bits);
    const Kernel::Bound value = polynomial.evaluate(low);
    if (CGAL::abs(value) > slope * (high - low)) return CGAL::sign(value);
    if (low == high) return CGAL::sign(value);
    if (bits > kFirstBits) continue;
    // The time is the only root of its polynomial between these bounds, and a simple one.
    const Polynomial common = common_divisor(polynomial, kernel.compute_polynomial_1_object()(t));
    if (common.sign_at(t.low()) != common.sign_at(t.high())) return 0;
  }
}

/// Whether there may be a root in (0,1), by Descartes' rule for p(1 / (1 + x)) (1 + x)^d over x > 0: without a change
/// of sign there is none.
bool may_vanish_inside(const Polynomial& polynomial) {
  const Polynomial moved = CGAL::translate(CGAL::invert(polynomial), CGAL::Gmpz(1));
  bool has_positive = false, has_negative = false;
  for (const CGAL::Gmpz& c : moved) {
    has_positive = has_positive || c > 0;
    has_negative = has_negative || c < 0;
  }
  return has_positive && has_negative;
}

/// With the roots that `divisor` lacks, each once if it was. REQUIRES that neither is zero.
Polynomial without(const Polynomial& polynomial, const Polynomial& divisor) {
  return primitive(CGAL::pseudo_division_quotient(polynomial, common_divisor(polynomial, divisor)));
}

/// A point and a segment of possibly no length. Polynomials are computed when a sign is asked for: the first of them
/// mostly decides.
class PointOnSegment {
 public:
  PointOnSegment(const Vector& p, const Vector& x, const Vector& y) : from_x_(p - x), edge_(y - x) {}

  [[nodiscard]] bool holds(const Time& t) const {
    if (sign_at(off_line(), t) != 0) return false;
    const Polynomial length_squared = norm_squared(edge_);
    if (sign_at(length_squared, t) == 0) return sign_at(norm_squared(from_x_), t) == 0;
    const Polynomial along = dot(from_x_, edge_);
    return sign_at(along, t) >= 0 && sign_at(length_squared - along, t) >= 0;
  }
  /// Polynomials at one of whose roots it begins to hold, unless it holds at t = 0.
  void add_critical(std::vector<Polynomial>& list) const {
    if (const Polynomial zero_where_it_holds = off_line(); !CGAL::is_zero(zero_where_it_holds)) {
      list.push_back(zero_where_it_holds);
    } else {
      const Polynomial length_squared = norm_squared(edge_), along = dot(from_x_, edge_);
      list.insert(list.end(), {length_squared, norm_squared(from_x_), along, length_squared - along});
    }
  }

 private:
  [[nodiscard]] Polynomial off_line() const { return norm_squared(cross(from_x_, edge_)); }

  Vector from_x_, edge_;
};

/// 0, 1, and all roots between of the polynomials that are not zero; ascending, each once.
std::vector<Time> critical_times(const std::vector<Polynomial>& polynomials) {
  std::vector<Time> times = {Time(0), Time(1)};
  std::vector<Polynomial> solved;
  for (const Polynomial& polynomial : polynomials) {
    if (CGAL::is_zero(polynomial) || !may_vanish_inside(polynomial)) continue;
    Polynomial square_free = without(polynomial, CGAL::differentiate(polynomial));
    // Equal roots of different polynomials would cost most of all when they are sorted.
    for (const Polynomial& other : solved) square_free = without(square_free, other);
    if (CGAL::degree(square_free) == 0) continue;
    std::vector<Time> roots;
    Kernel().solve_1_object()(square_free, true, std::back_inserter(roots));
    std::ranges::copy_if(roots, std::back_inserter(times), [](const Time& t) { return t > Time(0) && t < Time(1); });
    solved.push_back(std::move(square_free));
  }
  std::sort(times.begin(), times.end());
  return times;
}

/// The first of these times at which the features touch.
template <class Touches>
SecondOpinion first_touch(const std::vector<Time>& times, const Touches& touches) {
  for (const Time& t : times) {
    if (!touches(t)) continue;
    const auto [low, high] = Kernel().approximate_absolute_1_object()(t, 60);
    return {true, CGAL::to_interval(low).first, CGAL::to_interval(high).second};
  }
  return {};
}

struct VfPair {
  Vector p, a, b, c;

  [[nodiscard]] Vector normal() const { return cross(b - a, c - a); }
  [[nodiscard]] Vector difference() const { return p - a; }
  [[nodiscard]] std::vector<Polynomial> weights(const Vector& n) const {
    return {dot(cross(b - p, c - p), n), dot(cross(c - p, a - p), n), dot(cross(a - p, b - p), n)};
  }
  [[nodiscard]] std::vector<PointOnSegment> degenerate() const { return {{p, a, b}, {p, b, c}, {p, c, a}}; }
};

struct EePair {
  Vector a, b, c, d;

  [[nodiscard]] Vector normal() const { return cross(b - a, d - c); }
  [[nodiscard]] Vector difference() const { return c - a; }
  /// Each edge parameter, measured from either end.
  [[nodiscard]] std::vector<Polynomial> weights(const Vector& n) const {
    return {dot(cross(c - a, d - c), n), dot(cross(d - c, c - b), n), dot(cross(c - a, b - a), n),
            dot(cross(b - a, d - a), n)};
  }
  [[nodiscard]] std::vector<PointOnSegment> degenerate() const { return {{a, c, d}, {b, c, d}, {c, a, b}, {d, a, b}}; }
};

/// A pair that is coplanar, at all times or at those asked about, touches where it spans a plane and all weights (here
/// times the normal squared) are >= 0, or where a point is on a segment.
template <class Pair>
class CoplanarPair {
 public:
  CoplanarPair(const Pair& pair, const Vector& normal)
      : pair_(pair), normal_squared_(norm_squared(normal)), weights_(pair.weights(normal)) {}

  /// Touching is decided by the weights' signs where the normal is not zero, by the degenerate conditions elsewhere; so
  /// it begins at a root of a weight, of the normal, or, where the normal is always zero, of a condition.
  [[nodiscard]] std::vector<Polynomial> critical() const {
    std::vector<Polynomial> polynomials;
    if (!CGAL::is_zero(normal_squared_)) {
      polynomials = weights_;
      polynomials.push_back(normal_squared_);
    } else {
      for (const PointOnSegment& condition : pair_.degenerate()) condition.add_critical(polynomials);
    }
    return polynomials;
  }
  [[nodiscard]] bool touches(const Time& t) const {
    if (sign_at(normal_squared_, t) != 0) {
      return std::ranges::all_of(weights_, [&](const Polynomial& weight) { return sign_at(weight, t) >= 0; });
    }
    return std::ranges::any_of(pair_.degenerate(), [&](const PointOnSegment& condition) { return condition.holds(t); });
  }

 private:
  const Pair& pair_;
  Polynomial normal_squared_;
  std::vector<Polynomial> weights_;
};

template <class Pair>
SecondOpinion first_touch(const Pair& pair) {
  const Vector normal = pair.normal();
  const Polynomial coplanarity = dot(pair.difference(), normal);
  std::vector<Time> times;
  if (!CGAL::is_zero(coplanarity)) {
    times = critical_times({coplanarity});
    std::erase_if(times, [&](const Time& t) { return sign_at(coplanarity, t) != 0; });
    if (times.empty()) return {};
  }
  const CoplanarPair coplanar(pair, normal);
  if (CGAL::is_zero(coplanarity)) times = critical_times(coplanar.critical());
  return first_touch(times, [&coplanar](const Time& t) { return coplanar.touches(t); });
}

}  // namespace

SecondOpinion second_opinion_vf(const std::array<Point, 4>& x_t0, const std::array<Point, 4>& x_t1) {
  const FpGuard guard;
  require_directed_rounding();
  const auto [p, a, b, c] = paths(x_t0, x_t1);
  return first_touch(VfPair{p, a, b, c});
}

SecondOpinion second_opinion_ee(const std::array<Point, 4>& x_t0, const std::array<Point, 4>& x_t1) {
  const FpGuard guard;
  require_directed_rounding();
  const auto [a, b, c, d] = paths(x_t0, x_t1);
  return first_touch(EePair{a, b, c, d});
}

SecondOpinion second_opinion_self(const std::array<Point, 3>& x_t0, const std::array<Point, 3>& x_t1) {
  const FpGuard guard;
  require_directed_rounding();
  const auto [p, a, b] = paths(x_t0, x_t1);
  const PointOnSegment condition(p, a, b);
  std::vector<Polynomial> polynomials;
  condition.add_critical(polynomials);
  return first_touch(critical_times(polynomials), [&condition](const Time& t) { return condition.holds(t); });
}

}  // namespace selvage::verify
