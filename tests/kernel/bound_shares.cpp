#include "tests/kernel/bound_shares.h"

#include "kernel/arithmetic/rounding.h"
#include "kernel/query/closest_point.h"
#include "kernel/query/coplanarity.h"
#include "kernel/query/separation.h"
#include "tests/kernel/exact.h"

namespace selvage::testing {

using detail::Double3;
using detail::DoubleDouble;
using detail::PairMotion;
using detail::Triple;

namespace {

double random_value(Random& random) { return random.magnitude(-3, 0); }
DoubleDouble random_wide(Random& random) {
  const double high = random_value(random);
  return detail::two_sum(high, high * random.uniform() * 0x1p-54);
}

/// Gives one part of the case a new random value; `part` counts through all of them.
void redraw(BoundCase& c, Random& random, std::size_t part) {
  if (part < 24) {
    Double3& p = (part < 12 ? c.x_t0 : c.x_t1)[part % 4];
    (part % 3 == 0 ? p.x : part % 3 == 1 ? p.y : p.z) = random_value(random);
  } else if (part < 26) {
    c.tick[part - 24] = random.bits() >> 12;
  } else if (part < 29) {
    (part == 26 ? c.n.x : part == 27 ? c.n.y : c.n.z) = random_wide(random);
  } else {
    c.weights[part - 29] = std::fabs(random.uniform());
  }
}
constexpr std::size_t kParts = 33;

template <class Real>
Triple<Real> direction(const BoundCase& c);
template <>
Double3 direction<double>(const BoundCase& c) {
  return leading(c.n);
}
template <>
Triple<DoubleDouble> direction<DoubleDouble>(const BoundCase& c) {
  return c.n;
}

template <class Real>
detail::DifferencePolygon<Real> polygon_of(const PairMotion<Real>& motion, detail::Tick tick) {
  return detail::polygon_at(motion, Real(detail::time_of(detail::kTicks - tick)), Real(detail::time_of(tick)));
}

/// Exact corners at a tick, scaled as the motion is.
template <class Real>
std::array<Rational3, 4> real_corners(const BoundCase& c, const PairMotion<Real>& motion, detail::Tick tick) {
  auto corners = exact_corners(c.kind, exact_points(c.x_t0, c.x_t1, exact(detail::time_of(tick))));
  for (Rational3& corner : corners) {
    for (Rational& value : corner.axis) value = scaled_exactly(value, -motion.exponent);
  }
  return corners;
}

double share_of_point(const BoundCase& c) {
  const auto motion = detail::make_pair_motion<double>(c.kind, c.x_t0, c.x_t1);
  const auto polygon = polygon_of(motion, c.tick[0]);
  const auto real = real_corners(c, motion, c.tick[0]);
  const double bound = detail::kPointRoundings * detail::kUnitRoundoff;
  double share = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    share = std::max(share, ratio(exact(polygon.corner[k].x) - real[k][0], bound * motion.extent.x));
    share = std::max(share, ratio(exact(polygon.corner[k].y) - real[k][1], bound * motion.extent.y));
    share = std::max(share, ratio(exact(polygon.corner[k].z) - real[k][2], bound * motion.extent.z));
  }
  return share;
}

template <class Real>
double share_of_support(const BoundCase& c) {
  const auto motion = detail::make_pair_motion<Real>(c.kind, c.x_t0, c.x_t1);
  const auto polygon = polygon_of(motion, c.tick[0]);
  const auto real = real_corners(c, motion, c.tick[0]);
  const Triple<Real> n = direction<Real>(c);
  double share = 0;
  for (std::size_t k = 0; k < static_cast<std::size_t>(detail::corner_count(c.kind)); ++k) {
    const Rational error = exact(detail::dot(n, polygon.corner[k])) - dot(exact(n), real[k]);
    share = std::max(share, ratio(error, detail::support_error(n, motion.extent)));
  }
  return share;
}

/// Along an axis so short that its products underflow; another one, which n is orthogonal to, sets the scale.
double share_of_tiny_support(const BoundCase& c) {
  constexpr double kTiny = 0x1p-538;
  BoundCase tiny = c;
  for (auto* x : {&tiny.x_t0, &tiny.x_t1}) {
    for (Double3& p : *x) p = {p.x * kTiny, 0, p.z};
  }
  const auto motion = detail::make_pair_motion<double>(c.kind, tiny.x_t0, tiny.x_t1);
  const auto real = real_corners(tiny, motion, 0);
  const Double3 n{leading(c.n).x * kTiny, 0, 0};
  const double bound = detail::support_error(n, motion.extent);
  double share = 0;
  for (std::size_t k = 0; k < 2; ++k) {
    const Rational error = exact(detail::dot(n, motion.t0.corner[k])) - dot(exact(n), real[k]);
    if (error != 0) share = std::max(share, bound > 0 ? ratio(error, bound) : 2);
  }
  return share;
}

template <class Real>
double share_of_winding(const BoundCase& c) {
  const auto motion = detail::make_pair_motion<Real>(PairKind::kVf, c.x_t0, c.x_t1);
  std::array<detail::DifferencePolygon<Real>, 2> polygon;
  std::array<Rational3, 2> d, e;
  for (std::size_t i = 0; i < 2; ++i) {
    polygon[i] = polygon_of(motion, c.tick[i]);
    const auto real = real_corners({PairKind::kVf, c.x_t0, c.x_t1, {}, {}, {}}, motion, c.tick[i]);
    d[i] = real[0];
    e[i] = real[1] - real[0];
  }
  // Before the leading double is taken: that costs a rounding of its own, which the signs do not need.
  const Triple<Real> first = cross(polygon[0].corner[0], polygon[0].edge_u);
  const Triple<Real> middle =
      cross(polygon[0].corner[0], polygon[1].edge_u) + cross(polygon[1].corner[0], polygon[0].edge_u);
  const Rational3 real_first = cross(d[0], e[0]), real_middle = cross(d[0], e[1]) + cross(d[1], e[0]);
  const Double3 bound = detail::winding_error(motion);
  const auto largest = [](const Rational3& computed, const Rational3& real, const Double3& limit) {
    return std::max({ratio(computed[0] - real[0], limit.x), ratio(computed[1] - real[1], limit.y),
                     ratio(computed[2] - real[2], limit.z)});
  };
  return std::max(largest(exact(first), real_first, bound),
                  largest(exact(middle), real_middle, detail::scaled(2.0, bound)));
}

template <class Real>
double share_of_determinant(const BoundCase& c) {
  const auto motion = detail::make_pair_motion<Real>(PairKind::kVf, c.x_t0, c.x_t1);
  const auto cubic = detail::coplanarity_cubic(motion);
  const double bound = cubic.error_bound * (detail::kDeterminantError<Real> /
                                            (detail::kDeterminantError<Real> + detail::kBlossomError<Real>));
  std::array<Rational3, 2> u, v, r;
  for (std::size_t i = 0; i < 2; ++i) {
    const auto real = real_corners({PairKind::kVf, c.x_t0, c.x_t1, {}, {}, {}}, motion, i * detail::kTicks);
    u[i] = real[1] - real[0];
    v[i] = real[2] - real[0];
    r[i] = real[0];
  }
  const auto det = [&](std::size_t i, std::size_t j, std::size_t k) { return dot(cross(u[i], v[j]), r[k]); };
  const std::array<Rational, 4> real = {3 * det(0, 0, 0), det(1, 0, 0) + det(0, 1, 0) + det(0, 0, 1),
                                        det(1, 1, 0) + det(1, 0, 1) + det(0, 1, 1), 3 * det(1, 1, 1)};
  double share = 0;
  for (std::size_t k = 0; k < 4; ++k) share = std::max(share, ratio(exact(cubic.coefficient[k]) - real[k], bound));
  return share;
}

template <class Real>
double share_of_blossom(const BoundCase& c) {
  // Coefficients as they come, not those of a pair: then nothing of them is rounded.
  detail::CoplanarityCubic<Real> cubic;
  cubic.coefficient = {direction<Real>(c).x, direction<Real>(c).y, direction<Real>(c).z, Real(c.weights[0])};
  const auto [first, last] = std::minmax(c.tick[0], c.tick[1]);
  const auto local = detail::local_coefficients(cubic, {first, last});
  const Rational t[] = {exact(detail::time_of(first)), exact(detail::time_of(last))};
  double largest = 0, share = 0;
  for (const Real& value : cubic.coefficient) largest = std::max(largest, std::fabs(detail::leading(value)));
  for (std::size_t k = 0; k < 4; ++k) {
    std::array<Rational, 4> level;
    for (std::size_t i = 0; i < 4; ++i) level[i] = exact(cubic.coefficient[i]);
    for (std::size_t step = 0; step < 3; ++step) {
      const Rational& at = t[step < k ? 1 : 0];
      for (std::size_t i = 0; i < 3 - step; ++i) level[i] = (1 - at) * level[i] + at * level[i + 1];
    }
    share = std::max(share, ratio(exact(local[k]) - level[0], detail::kBlossomError<Real> * largest));
  }
  return share;
}

double share_of_witness(const BoundCase& c) {
  const auto motion = detail::make_pair_motion<double>(PairKind::kEe, c.x_t0, c.x_t1);
  const auto real = real_corners({PairKind::kEe, c.x_t0, c.x_t1, {}, {}, {}}, motion, 0);
  const auto w = detail::corner_weights(PairKind::kEe, c.weights);
  double sum = 0, total = 0;
  Rational real_sum;
  for (std::size_t i = 0; i < 4; ++i) {
    sum += w[i] * motion.t0.corner[i].x;
    total += w[i] * std::fabs(motion.t0.corner[i].x);
    real_sum += exact(c.weights[i / 2]) * exact(c.weights[2 + i % 2]) * real[i][0];
  }
  return ratio(exact(sum) - real_sum, detail::kWitnessError * total);
}

/// What distance_upper adds to the computed distance of the witness, on a line, where nothing else is lost.
template <bool blended>
double share_of_gap(const BoundCase& c) {
  BoundCase on_line = c;
  on_line.kind = PairKind::kEe;
  for (auto* x : {&on_line.x_t0, &on_line.x_t1}) {
    for (Double3& p : *x) p.y = p.z = 0;
  }
  const auto motion = detail::make_pair_motion<double>(on_line.kind, on_line.x_t0, on_line.x_t1);
  const detail::Tick tick = blended ? c.tick[0] : 0;
  const auto polygon = polygon_of(motion, tick);
  const auto real = real_corners(on_line, motion, tick);
  const auto w = detail::corner_weights(on_line.kind, c.weights);
  double sum = 0, total = 0;
  Rational real_sum, real_total;
  for (std::size_t i = 0; i < 4; ++i) {
    const Rational weight = exact(c.weights[i / 2]) * exact(c.weights[2 + i % 2]);
    sum += w[i] * polygon.corner[i].x;
    total += w[i];
    real_sum += weight * real[i][0];
    real_total += weight;
  }
  const double computed = std::fabs(sum) / total;
  const double upper = detail::distance_upper(motion, polygon, blended, c.weights);
  const Rational distance = abs(real_sum) / real_total;
  return upper > computed ? ratio(distance - exact(computed), upper - computed) : 0;
}

double share_of_lane(const BoundCase& c) {
  const std::array<float, 3> n = {static_cast<float>(leading(c.n).x), static_cast<float>(leading(c.n).y),
                                  static_cast<float>(leading(c.n).z)};
  std::array<float, 2> computed;
  std::array<Rational, 2> real;
  for (std::size_t i = 0; i < 2; ++i) {
    const Double3& x = c.x_t0[i];
    computed[i] = (n[0] * static_cast<float>(x.x) + n[1] * static_cast<float>(x.y)) + n[2] * static_cast<float>(x.z);
    const Double3 normal = {static_cast<double>(n[0]), static_cast<double>(n[1]), static_cast<double>(n[2])};
    real[i] = dot(exact(normal), exact(x));
  }
  const float bound = detail::kNearError * (std::fabs(n[0]) + std::fabs(n[1]) + std::fabs(n[2]));
  const auto difference = static_cast<double>(computed[0] - computed[1]);
  return ratio(exact(difference) - (real[0] - real[1]), static_cast<double>(bound));
}

double share_of_norm(const BoundCase& c) {
  const Double3& v = c.x_t0[0];
  // norm^2 / v^2 - 1 is twice the relative error, to first order.
  const Rational norm_squared = squared(exact(detail::norm(v))) / dot(exact(v), exact(v));
  return ratio(norm_squared - 1, 2 * detail::kNormError);
}

/// |computed^2 / real^2 - 1| / 2, the relative error to first order, over the bound.
double relative_share(double computed, const Rational& real_squared, double bound) {
  return ratio(squared(exact(computed)) / real_squared - 1, 2 * bound);
}

/// Of a margin over a norm.
double share_of_quotient(const BoundCase& c) {
  const Double3& n = c.x_t0[0];
  const double support = c.weights[0], error = c.weights[1] * 0x1p-8;
  if (!(support > error)) return 0;
  const Rational real_squared = squared(exact(support) - exact(error)) / dot(exact(n), exact(n));
  return relative_share((support - error) / detail::norm(n), real_squared, detail::kQuotientError);
}

/// Of a norm over the sum of weights.
double share_of_witness_quotient(const BoundCase& c) {
  const Double3& v = c.x_t0[0];
  const auto w = detail::corner_weights(PairKind::kEe, c.weights);
  double weight_total = 0;
  for (const double weight : w) weight_total += weight;
  const Rational real_total = (exact(c.weights[0]) + exact(c.weights[1])) * (exact(c.weights[2]) + exact(c.weights[3]));
  if (real_total == 0) return 0;
  const double computed = detail::norm(v) / weight_total;
  return relative_share(computed, dot(exact(v), exact(v)) / squared(real_total), detail::kWitnessQuotientError);
}

constexpr Bound kBounds[] = {{"point", share_of_point},
                             {"support", share_of_support<double>},
                             {"support, underflow", share_of_tiny_support, 0},  // 2^-1000 is far beyond 2^-1074
                             {"winding", share_of_winding<double>},
                             {"determinant", share_of_determinant<double>},
                             {"blossom", share_of_blossom<double>},
                             {"witness", share_of_witness},
                             {"gap", share_of_gap<false>},
                             {"gap, blended", share_of_gap<true>},
                             {"norm", share_of_norm},
                             {"quotient", share_of_quotient},
                             {"witness quotient", share_of_witness_quotient},
                             {"lane", share_of_lane},
                             {"support, double-double", share_of_support<DoubleDouble>},
                             {"winding, double-double", share_of_winding<DoubleDouble>},
                             {"determinant, double-double", share_of_determinant<DoubleDouble>},
                             {"blossom, double-double", share_of_blossom<DoubleDouble>}};

}  // namespace

std::span<const Bound> bounds() { return kBounds; }

double climb(const Bound& bound, Random& random) {
  constexpr int kSteps = 150;
  BoundCase best;
  for (std::size_t part = 0; part < kParts; ++part) redraw(best, random, part);
  best.kind = random.chance(2) ? PairKind::kVf : PairKind::kEe;
  double share = bound.share_of(best);
  for (int step = 0; step < kSteps; ++step) {
    BoundCase next = best;
    redraw(next, random, static_cast<std::size_t>(random.integer(0, kParts - 1)));
    const double other = bound.share_of(next);
    if (other < share) continue;
    best = next;
    share = other;
  }
  return share;
}

}  // namespace selvage::testing
