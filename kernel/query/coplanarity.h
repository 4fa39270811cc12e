// The cubic whose roots are the times at which the four points of a pair are coplanar (paper, section 6), in Bernstein
// form with proven coefficient errors. No root in an interval: no touch in it, degenerate features included.
#pragma once

#include "kernel/arithmetic/time_ticks.h"
#include "kernel/query/pair_motion.h"

namespace selvage::detail {

template <class Real>
struct CoplanarityCubic {
  std::array<Real, 4> coefficient = {};  ///< Bernstein coefficients over [0,1]
  double error_bound = 0;                ///< PROVED: of each coefficient, and of every value computed from them
};

/// 3 det[edge_u(t), edge_v(t), corner_0(t)], the 3 sparing two divisions. REQUIRES kind kVf or kEe.
template <class Real>
[[nodiscard]] CoplanarityCubic<Real> coplanarity_cubic(const PairMotion<Real>& motion);

/// The cubic at t, good to error_bound.
[[nodiscard]] double value_at(const CoplanarityCubic<double>& cubic, double t);

/// Bernstein coefficients over the interval, each good to error_bound.
template <class Real>
[[nodiscard]] std::array<Real, 4> local_coefficients(const CoplanarityCubic<Real>& cubic, const TickInterval& interval);

extern template CoplanarityCubic<double> coplanarity_cubic(const PairMotion<double>&);
extern template CoplanarityCubic<DoubleDouble> coplanarity_cubic(const PairMotion<DoubleDouble>&);
extern template std::array<double, 4> local_coefficients(const CoplanarityCubic<double>&, const TickInterval&);
extern template std::array<DoubleDouble, 4> local_coefficients(const CoplanarityCubic<DoubleDouble>&,
                                                               const TickInterval&);

}  // namespace selvage::detail
