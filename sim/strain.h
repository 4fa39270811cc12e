// Limits on strain and strain rate, as momentum-conserving changes of velocity (paper, section 4).
#pragma once

#include <cstdint>
#include <span>

#include "sim/spring.h"

namespace selvage::sim {

struct StrainLimits {
  double strain = 0.1;  ///< of the rest length, at the end of the step; 0: no limit. Dimensionless; section 4: 10 %
  double strain_rate = 0.1;            ///< of the current length, per step; 0: no limit. Dimensionless; section 4: 10 %
  std::int32_t strain_iterations = 2;  ///< section 4: "generally only one or two iterations"
  std::int32_t strain_rate_iterations = 4;  ///< section 4: "only a few iterations are needed"
};

/// Both functions look at structural and shear springs, change v by impulses along the springs at x, and leave the rows
/// of vertices with inverse mass 0 alone. Impulses are equal and opposite, so linear momentum and angular momentum
/// about x are kept to rounding. Each impulse by itself takes energy away. They return the number of impulses.

/// Jacobi: all springs are judged by the same velocities. A spring that would end the step of dt_s longer (shorter)
/// than its limit is slowed until it ends there; one that is beyond its limit already is kept from getting worse, and
/// its own force brings it back: pulling it back within the step would put energy in. The impulses at a
/// vertex with n active springs are divided by n: the sum of n rank-one corrections n_s n_s^T has eigenvalues up to n.
std::int64_t limit_strain(const SpringSystem& springs, std::span<const double> inverse_mass, const PositionsRef& x,
                          double dt_s, const StrainLimits& limits, Positions& v);

/// Gauss-Seidel in the order of the springs: no spring changes its length by more than strain_rate within dt_s. Stops
/// early when a sweep finds nothing.
std::int64_t limit_strain_rate(const SpringSystem& springs, std::span<const double> inverse_mass, const PositionsRef& x,
                               double dt_s, const StrainLimits& limits, Positions& v);

}  // namespace selvage::sim
