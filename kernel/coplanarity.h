// The cubic whose roots are the times at which the four points of a pair are coplanar (paper, section 6), in Bernstein
// form with proven coefficient errors. No root in an interval: no touch in it, degenerate features included.
#pragma once

#include "kernel/pair_motion.h"

namespace selvage::detail {

struct CoplanarityCubic {
  std::array<double, 4> coefficient = {};  ///< Bernstein coefficients over [0,1]
  double error_bound = 0;                  ///< PROVED: of each coefficient
};

/// det[edge_u(t), edge_v(t), corner_0(t)]. REQUIRES kind kVf or kEe.
[[nodiscard]] CoplanarityCubic coplanarity_cubic(const PairMotion& motion);

/// PROVED when true: the exact cubic has one sign on all of [t_begin, t_end], both multiples of 2^-52.
[[nodiscard]] bool is_definite(const CoplanarityCubic& cubic, double t_begin, double t_end);

}  // namespace selvage::detail
