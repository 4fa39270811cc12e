// The velocity at the end of a step when damping is not linear: an explicit march (paper, section 7.6).
#pragma once

#include <functional>

#include "kernel/types.h"

namespace selvage::sim {

/// a(v) in m/s^2, row by row, at the fixed time and positions of the end of the step.
using AccelerationOfVelocity = std::function<void(const Positions& v, Positions& acceleration)>;

/// A march step k keeps k |lambda_max(da/dv)| at or below this, so that each fixed-point iteration at least halves the
/// error ("k |lambda_max| < 1 in order to guarantee convergence", 7.6).
inline constexpr double kMarchContraction = 0.5;
/// Iterations a march step: the first error of a step is k a, what is left after eight is 1/256 of it, below the
/// method's own error of first order.
inline constexpr int kFixedPointIterations = 8;
/// More steps than this are not taken; the rate would ask for them only in a simulation that has blown up.
inline constexpr int kMarchStepLimit = 10'000;

/// Of each row: acceleration -(linear + quadratic |v|) v; none is below zero.
struct RowDrag {
  Eigen::ArrayXd linear_1_s, quadratic_1_m;
};

/// Advances v by M steps u(m+1) = u(m) + k (a(u(m+1)) - drag(u(m+1)) u(m+1)), M k = time_s, each solved by fixed-point
/// iteration from u(m). That divides by 1 + k drag(u), so no drag is too strong for it: of drag alone it contracts by
/// k |d drag/du u| / (1 + k drag) < 1. `rate_upper_1_s` bounds |lambda_max| of all of this on the way; M is
/// time_s rate_upper_1_s / kMarchContraction, rounded up, and at least 1. First order in time_s / M.
void march_velocity(const AccelerationOfVelocity& acceleration, const RowDrag& drag, double rate_upper_1_s,
                    double time_s, Positions& v);

}  // namespace selvage::sim
