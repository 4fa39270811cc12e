// The velocity at the end of a step when damping is implicit (paper, section 7.6), by conjugate gradients.
#pragma once

#include <span>
#include <vector>

#include "sim/spring.h"

namespace selvage::sim {

struct VelocitySystem {
  const SpringSystem& springs;
  std::span<const double> inverse_mass;
  double drag_1_s = 0;                         ///< acceleration -drag v, on top of the springs
  std::span<const double> spring_coefficient;  ///< per spring: impulse per rate of elongation, N s / (m/s)
};

/// Solves (I + dt drag) v + M^-1 B v = rhs for v, where B is SpringSystem::apply with spring_coefficient, on the rows
/// with inverse mass > 0; the other rows of v are given and kept. v holds the first guess.
/// Multiplied by M the matrix is symmetric positive definite, so conjugate gradients with the diagonal as
/// preconditioner apply. Ends when the residual is 1e-9 of the right-hand side, in the norm of the preconditioner, or
/// after 200 iterations; what is left of the residual then is an error in damping alone, never in positions. Returns
/// the number of iterations. Deterministic for any thread count.
std::int32_t solve_velocity(const VelocitySystem& system, const Positions& direction, const Positions& rhs, double dt_s,
                            Positions& v);

}  // namespace selvage::sim
