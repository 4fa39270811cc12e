#include "kernel/query/pair_motion.h"

#include "kernel/arithmetic/power_of_two.h"

namespace selvage::detail {

namespace {

template <class Real>
Real difference(double a, double b);
template <>
double difference(double a, double b) {
  return a - b;
}
template <>
DoubleDouble difference(double a, double b) {
  return two_sum(a, -b);
}

template <class Real>
Triple<Real> difference(const Double3& p, const Double3& q) {
  return {difference<Real>(p.x, q.x), difference<Real>(p.y, q.y), difference<Real>(p.z, q.z)};
}

template <class Real>
DifferencePolygon<Real> differences(PairKind kind, const PairPoints& x) {
  const auto d = [&x](std::size_t i, std::size_t j) { return difference<Real>(x[i], x[j]); };
  switch (kind) {
    case PairKind::kVf:
      return {{d(0, 1), d(0, 2), d(0, 3)}, d(1, 2), d(1, 3), d(2, 3)};
    case PairKind::kEe:
      return {{d(0, 2), d(0, 3), d(1, 2), d(1, 3)}, d(1, 0), d(2, 3), {}};
    case PairKind::kSelf:
      break;
  }
  return {{d(0, 1), d(0, 2)}, d(1, 2), {}, {}};
}

template <class Real>
Double3 extent_of(const DifferencePolygon<Real>& polygon) {
  const auto& c = polygon.corner;
  return max(max(abs(leading(c[0])), abs(leading(c[1]))), max(abs(leading(c[2])), abs(leading(c[3]))));
}

template <class Real>
Double3 edge_extent_of(const DifferencePolygon<Real>& polygon) {
  return max(max(abs(leading(polygon.edge_u)), abs(leading(polygon.edge_v))), abs(leading(polygon.edge_w)));
}

template <class Real, class Map>
void for_each_vector(DifferencePolygon<Real>& polygon, Map map) {
  for (Triple<Real>& corner : polygon.corner) map(corner);
  map(polygon.edge_u);
  map(polygon.edge_v);
  map(polygon.edge_w);
}

template <class Real>
Triple<Real> blend(const Triple<Real>& a, const Triple<Real>& b, const Real& s, const Real& t) {
  return {s * a.x + t * b.x, s * a.y + t * b.y, s * a.z + t * b.z};
}

}  // namespace

template <class Real>
PairMotion<Real> make_pair_motion(PairKind kind, const PairPoints& x_t0, const PairPoints& x_t1) {
  PairMotion<Real> motion;
  motion.kind = kind;
  motion.t0 = differences<Real>(kind, x_t0);
  motion.t1 = differences<Real>(kind, x_t1);
  const Double3 extent = max(extent_of(motion.t0), extent_of(motion.t1));
  const Double3 edge_extent = max(edge_extent_of(motion.t0), edge_extent_of(motion.t1));
  const double largest = max_component(extent);
  const int e = motion.exponent = largest > 0 ? exponent_of(largest) : 0;
  if (e > 0) {  // scaling down loses bits of values that fall below the normal doubles; scaling up is exact
    const double least_exact = times_power(std::numeric_limits<double>::min(), e);
    const auto check = [&motion, least_exact](const Triple<Real>& v) {
      for (const double value : {leading(v.x), leading(v.y), leading(v.z)}) {
        motion.exact_scaling &= value == 0 || !(std::fabs(value) < least_exact);
      }
    };
    for_each_vector(motion.t0, check);
    for_each_vector(motion.t1, check);
  }
  const auto scale = [e](Triple<Real>& v) { v = times_power(v, -e); };
  for_each_vector(motion.t0, scale);
  for_each_vector(motion.t1, scale);
  motion.extent = times_power(extent, -e);  // scaling is monotone: these bound the scaled values
  motion.edge_extent = times_power(edge_extent, -e);
  return motion;
}

template <class Real>
DifferencePolygon<Real> polygon_at(const PairMotion<Real>& motion, const Real& s, const Real& t) {
  DifferencePolygon<Real> polygon;
  for (std::size_t i = 0; i < polygon.corner.size(); ++i) {
    polygon.corner[i] = blend(motion.t0.corner[i], motion.t1.corner[i], s, t);
  }
  polygon.edge_u = blend(motion.t0.edge_u, motion.t1.edge_u, s, t);
  polygon.edge_v = blend(motion.t0.edge_v, motion.t1.edge_v, s, t);
  polygon.edge_w = blend(motion.t0.edge_w, motion.t1.edge_w, s, t);
  return polygon;
}

template PairMotion<double> make_pair_motion(PairKind, const PairPoints&, const PairPoints&);
template PairMotion<DoubleDouble> make_pair_motion(PairKind, const PairPoints&, const PairPoints&);
template DifferencePolygon<double> polygon_at(const PairMotion<double>&, const double&, const double&);
template DifferencePolygon<DoubleDouble> polygon_at(const PairMotion<DoubleDouble>&, const DoubleDouble&,
                                                    const DoubleDouble&);

}  // namespace selvage::detail
