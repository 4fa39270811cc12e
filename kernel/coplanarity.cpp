#include "kernel/coplanarity.h"

#include "kernel/rounding.h"

namespace selvage::detail {

namespace {

/// The blossom: the polynomial made symmetric and affine in three times; it gives Bernstein coefficients over any
/// interval.
template <class Real>
Real blossom(const std::array<Real, 4>& c, double t1, double t2, double t3) {
  const auto blend = [](const Real& a, const Real& b, double t) { return Real(1 - t) * a + Real(t) * b; };
  return blend(blend(blend(c[0], c[1], t1), blend(c[1], c[2], t1), t2),
               blend(blend(c[1], c[2], t1), blend(c[2], c[3], t1), t2), t3);
}

template <class Real>
Double3 extent_of(const Triple<Real>& a, const Triple<Real>& b) {
  return max(abs(leading(a)), abs(leading(b)));
}

/// Sum of a_i b_j c_k over all permutations: bounds the sum of the absolute terms of a determinant.
double permanent(const Double3& a, const Double3& b, const Double3& c) {
  const Double3 minors = {a.y * b.z + a.z * b.y, a.z * b.x + a.x * b.z, a.x * b.y + a.y * b.x};
  return dot(minors, c);
}

}  // namespace

template <class Real>
CoplanarityCubic<Real> coplanarity_cubic(const PairMotion<Real>& motion) {
  const Triple<Real>&u0 = motion.t0.edge_u, &v0 = motion.t0.edge_v, &r0 = motion.t0.corner[0];
  const Triple<Real>&u1 = motion.t1.edge_u, &v1 = motion.t1.edge_v, &r1 = motion.t1.corner[0];
  const Triple<Real> first = cross(u0, v0), last = cross(u1, v1);
  const Triple<Real> middle_doubled = cross(u0, v1) + cross(u1, v0);
  CoplanarityCubic<Real> cubic;
  cubic.coefficient = {Real(3) * dot(first, r0), dot(middle_doubled, r0) + dot(first, r1),
                       dot(last, r0) + dot(middle_doubled, r1), Real(3) * dot(last, r1)};
  // Values computed from the coefficients are convex combinations of them, rounded; all are below the permanent.
  const double scale = 3 * permanent(extent_of(u0, u1), extent_of(v0, v1), extent_of(r0, r1));
  cubic.error_bound = (kDeterminantError<Real> + kBlossomError<Real>)*scale + kUnderflowError;
  return cubic;
}

template <class Real>
std::array<Real, 4> local_coefficients(const CoplanarityCubic<Real>& cubic, const TickInterval& interval) {
  const double t0 = time_of(interval.begin), t1 = time_of(interval.end);
  const auto& c = cubic.coefficient;
  return {blossom(c, t0, t0, t0), blossom(c, t0, t0, t1), blossom(c, t0, t1, t1), blossom(c, t1, t1, t1)};
}

template <class Real>
bool is_definite(const CoplanarityCubic<Real>& cubic, const TickInterval& interval) {
  const std::array<Real, 4> local = local_coefficients(cubic, interval);
  bool positive = true, negative = true;
  for (const Real& c : local) {
    positive &= leading(c) > cubic.error_bound;
    negative &= leading(c) < -cubic.error_bound;
  }
  return positive || negative;
}

template CoplanarityCubic<double> coplanarity_cubic(const PairMotion<double>&);
template CoplanarityCubic<DoubleDouble> coplanarity_cubic(const PairMotion<DoubleDouble>&);
template std::array<double, 4> local_coefficients(const CoplanarityCubic<double>&, const TickInterval&);
template std::array<DoubleDouble, 4> local_coefficients(const CoplanarityCubic<DoubleDouble>&, const TickInterval&);
template bool is_definite(const CoplanarityCubic<double>&, const TickInterval&);
template bool is_definite(const CoplanarityCubic<DoubleDouble>&, const TickInterval&);

}  // namespace selvage::detail
