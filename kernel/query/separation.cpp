#include "kernel/query/separation.h"

#include "kernel/arithmetic/power_of_two.h"

namespace selvage::detail {

namespace {

/// Steps of Gilbert's algorithm. Most intervals that it can certify need four; the others are cheaper to halve.
constexpr int kGilbertSteps = 6;

template <class Real>
struct Support {
  Real least;
  const Triple<Real>* corner;
};

template <class Real>
Support<Real> support(const PairMotion<Real>& motion, const DifferencePolygon<Real>& begin,
                      const DifferencePolygon<Real>& end, const Triple<Real>& n) {
  Support<Real> result{dot(n, begin.corner[0]), &begin.corner[0]};
  const auto count = static_cast<std::size_t>(corner_count(motion.kind));
  for (const DifferencePolygon<Real>* polygon : {&begin, &end}) {
    for (std::size_t i = 0; i < count; ++i) {
      const Real value = dot(n, polygon->corner[i]);
      if (value < result.least) result = {value, &polygon->corner[i]};
    }
  }
  return result;
}

/// Which signs the quadratics along each axis keep over an interval.
class Signs {
 public:
  /// Bernstein coefficients, the middle one doubled; `bound` is the error of the outer ones.
  void add(std::size_t axis, double first, double middle_doubled, double last, double bound, bool along) {
    const bool positive = first > bound && middle_doubled > 2 * bound && last > bound;
    const bool negative = first < -bound && middle_doubled < -2 * bound && last < -bound;
    positive_[axis] |= along ? positive : negative;
    negative_[axis] |= along ? negative : positive;
  }
  [[nodiscard]] bool opposite() const {
    return (positive_[0] && negative_[0]) || (positive_[1] && negative_[1]) || (positive_[2] && negative_[2]);
  }

 private:
  std::array<bool, 3> positive_ = {}, negative_ = {};
};

}  // namespace

template <class Real>
double support_error(const Triple<Real>& n, const Double3& extent) {
  return kSupportError<Real> * dot(abs(leading(n)), extent) + kUnderflowError;
}

template <class Real>
bool separates(const PairMotion<Real>& motion, const DifferencePolygon<Real>& begin, const DifferencePolygon<Real>& end,
               const Triple<Real>& n) {
  const double error = support_error(n, motion.extent);
  const auto count = static_cast<std::size_t>(corner_count(motion.kind));
  for (const DifferencePolygon<Real>* polygon : {&begin, &end}) {
    for (std::size_t i = 0; i < count; ++i) {
      if (!(leading(dot(n, polygon->corner[i])) > error)) return false;
    }
  }
  return true;
}

// n . D_j is linear in time; it must stay above its error bound, twice that to leave room for the rounding of the
// split.
template <class Real>
Reach<Real> separated_reach(const PairMotion<Real>& motion, const DifferencePolygon<Real>& begin,
                            const DifferencePolygon<Real>& end, const ClosestPoint<Real>& closest) {
  const auto share_of = [&](const Triple<Real>& n) {
    const double error = 2 * support_error(n, motion.extent);
    double share = 1;
    for (std::size_t i = 0; i < static_cast<std::size_t>(corner_count(motion.kind)); ++i) {
      const double first = leading(dot(n, begin.corner[i])) - error, last = leading(dot(n, end.corner[i])) - error;
      if (!(first > 0)) return 0.0;
      if (last < 0) share = std::min(share, first / (first - last));
    }
    return share;
  };
  const double along = share_of(closest.direction), across = share_of(closest.plane_normal);
  return along < across ? Reach<Real>{across, closest.plane_normal} : Reach<Real>{along, closest.direction};
}

template <class Real>
bool winds_apart(const PairMotion<Real>& motion, const DifferencePolygon<Real>& begin,
                 const DifferencePolygon<Real>& end) {
  const Double3 bound = winding_error(motion);
  Signs signs;
  const auto add = [&](std::size_t corner, const Triple<Real>& edge_begin, const Triple<Real>& edge_end, bool along) {
    const CrossMotion c = cross_motion(begin.corner[corner], end.corner[corner], edge_begin, edge_end);
    signs.add(0, c.first.x, c.middle_doubled.x, c.last.x, bound.x, along);
    signs.add(1, c.first.y, c.middle_doubled.y, c.last.y, bound.y, along);
    signs.add(2, c.first.z, c.middle_doubled.z, c.last.z, bound.z, along);
  };
  switch (motion.kind) {  // around the polygon; `along` tells whether the edge is stored in that direction
    case PairKind::kVf:
      add(0, begin.edge_u, end.edge_u, true);
      add(1, begin.edge_w, end.edge_w, true);
      add(2, begin.edge_v, end.edge_v, false);
      break;
    case PairKind::kEe:
      add(0, begin.edge_v, end.edge_v, true);
      add(1, begin.edge_u, end.edge_u, true);
      add(3, begin.edge_v, end.edge_v, false);
      add(2, begin.edge_u, end.edge_u, false);
      break;
    case PairKind::kSelf:  // there and back
      add(0, begin.edge_u, end.edge_u, true);
      add(1, begin.edge_u, end.edge_u, false);
      break;
  }
  return signs.opposite();
}

template <class Real>
std::optional<Triple<Real>> separating_direction(const PairMotion<Real>& motion, const DifferencePolygon<Real>& begin,
                                                 const DifferencePolygon<Real>& end, Triple<Real> point) {
  for (int step = 0; step < kGilbertSteps; ++step) {
    const Triple<Real> n = normalize_exponent(point);
    const Support<Real> next = support(motion, begin, end, n);
    if (leading(next.least) > support_error(n, motion.extent)) return n;
    const Triple<Real> toward = *next.corner - point;
    const Real fraction = -dot(point, toward) / dot(toward, toward);
    if (!(leading(fraction) > 0)) return std::nullopt;
    point = fraction < Real(1) ? point + scaled(fraction, toward) : *next.corner;
  }
  return std::nullopt;
}

template double support_error(const Double3&, const Double3&);
template double support_error(const Triple<DoubleDouble>&, const Double3&);
template bool separates(const PairMotion<double>&, const DifferencePolygon<double>&, const DifferencePolygon<double>&,
                        const Double3&);
template bool separates(const PairMotion<DoubleDouble>&, const DifferencePolygon<DoubleDouble>&,
                        const DifferencePolygon<DoubleDouble>&, const Triple<DoubleDouble>&);
template Reach<double> separated_reach(const PairMotion<double>&, const DifferencePolygon<double>&,
                                       const DifferencePolygon<double>&, const ClosestPoint<double>&);
template Reach<DoubleDouble> separated_reach(const PairMotion<DoubleDouble>&, const DifferencePolygon<DoubleDouble>&,
                                             const DifferencePolygon<DoubleDouble>&, const ClosestPoint<DoubleDouble>&);
template bool winds_apart(const PairMotion<double>&, const DifferencePolygon<double>&,
                          const DifferencePolygon<double>&);
template bool winds_apart(const PairMotion<DoubleDouble>&, const DifferencePolygon<DoubleDouble>&,
                          const DifferencePolygon<DoubleDouble>&);
template std::optional<Double3> separating_direction(const PairMotion<double>&, const DifferencePolygon<double>&,
                                                     const DifferencePolygon<double>&, Double3);
template std::optional<Triple<DoubleDouble>> separating_direction(const PairMotion<DoubleDouble>&,
                                                                  const DifferencePolygon<DoubleDouble>&,
                                                                  const DifferencePolygon<DoubleDouble>&,
                                                                  Triple<DoubleDouble>);

SupportedDistance supported_distance(const PairMotion<double>& motion, const DifferencePolygon<double>& polygon,
                                     const ClosestPoint<double>& closest) {
  constexpr double kGoodShare = 1 - 0x1p-30;
  SupportedDistance best = {0, closest.direction};
  const auto consider = [&](const Double3& n) {
    const Support<double> least = support(motion, polygon, polygon, n);
    const double margin = least.least - support_error(n, motion.extent);
    const double lower = margin > 0 ? margin / norm(n) * (1 - kQuotientError) : 0;
    if (lower > best.lower) best = {lower, n};
    return least.corner;
  };
  consider(closest.direction);
  consider(closest.plane_normal);
  const double good = kGoodShare * norm(closest.point);
  Double3 point = closest.point;
  for (int step = 0; step < kGilbertSteps && best.lower < good; ++step) {
    const Double3 toward = *consider(normalize_exponent(point)) - point;
    const double fraction = -dot(point, toward) / dot(toward, toward);
    if (!(fraction > 0)) break;
    point = point + scaled(std::min(fraction, 1.0), toward);
  }
  return best;
}

double distance_upper(const PairMotion<double>& motion, const DifferencePolygon<double>& polygon, bool blended,
                      const std::array<double, 4>& weights) {
  const std::array<double, 4> w = corner_weights(motion.kind, weights);
  Double3 sum, total;  // of w_i x_i, and of w_i |x_i|
  double weight_total = 0;
  bool zero = motion.exact_scaling && !blended;
  for (std::size_t i = 0; i < w.size(); ++i) {
    sum = sum + scaled(w[i], polygon.corner[i]);
    total = total + scaled(w[i], abs(polygon.corner[i]));
    weight_total += w[i];
    // A product of two weights may have underflown to zero: ask the weights themselves.
    const bool unused = motion.kind == PairKind::kEe ? weights[i / 2] == 0 || weights[2 + i % 2] == 0 : w[i] == 0;
    zero &= unused || is_zero(polygon.corner[i]);
  }
  if (zero) return 0;
  const Double3 blend_extent = blended ? motion.extent : Double3{};
  const Double3 worst = (abs(sum) + scaled(kWitnessError, total)) + scaled(kBlendError, blend_extent);
  // The exact weights are divided by their exact sum, so that they make a convex combination.
  return norm(worst) / weight_total * (1 + kWitnessQuotientError) + kUnderflowError;
}

double norm(const Double3& v) {
  const double largest = max_component(abs(v));
  if (!(largest > 0)) return largest;  // 0 or NaN
  const int exponent = exponent_of(largest);
  const Double3 unit = times_power(v, -exponent);
  return times_power(std::sqrt(dot(unit, unit)), exponent);
}

}  // namespace selvage::detail
