#include "kernel/query/coplanarity.h"

#include "kernel/arithmetic/rounding.h"

namespace selvage::detail {

namespace {

template <class Real>
Real blend(const Real& a, const Real& b, double t) {
  return Real(1 - t) * a + Real(t) * b;
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

double value_at(const CoplanarityCubic<double>& cubic, double t) {
  const auto& c = cubic.coefficient;
  const double a = blend(c[0], c[1], t), b = blend(c[1], c[2], t), d = blend(c[2], c[3], t);
  return blend(blend(a, b, t), blend(b, d, t), t);
}

// The blossom, the polynomial made symmetric and affine in three times, at all choices of them from both ends; what two
// choices share is computed once. b: one time at the begin, e: at the end.
template <class Real>
std::array<Real, 4> local_coefficients(const CoplanarityCubic<Real>& cubic, const TickInterval& interval) {
  const double t0 = time_of(interval.begin), t1 = time_of(interval.end);
  const auto& c = cubic.coefficient;
  const Real b0 = blend(c[0], c[1], t0), b1 = blend(c[1], c[2], t0), b2 = blend(c[2], c[3], t0);
  const Real e0 = blend(c[0], c[1], t1), e1 = blend(c[1], c[2], t1), e2 = blend(c[2], c[3], t1);
  const Real bb0 = blend(b0, b1, t0), bb1 = blend(b1, b2, t0);
  const Real be0 = blend(b0, b1, t1), be1 = blend(b1, b2, t1);
  const Real ee0 = blend(e0, e1, t1), ee1 = blend(e1, e2, t1);
  return {blend(bb0, bb1, t0), blend(bb0, bb1, t1), blend(be0, be1, t1), blend(ee0, ee1, t1)};
}

template CoplanarityCubic<double> coplanarity_cubic(const PairMotion<double>&);
template CoplanarityCubic<DoubleDouble> coplanarity_cubic(const PairMotion<DoubleDouble>&);
template std::array<double, 4> local_coefficients(const CoplanarityCubic<double>&, const TickInterval&);
template std::array<DoubleDouble, 4> local_coefficients(const CoplanarityCubic<DoubleDouble>&, const TickInterval&);

}  // namespace selvage::detail
