// The velocity at the end of a step when damping is implicit (paper, section 7.6), by conjugate gradients.
#pragma once

#include <span>
#include <vector>

#include "sim/spring.h"
#include "sim/stabilizer.h"

namespace selvage::sim {

struct VelocitySystem {
  const SpringSystem& springs;
  std::span<const double> inverse_mass;
  double drag_1_s = 0;                         ///< acceleration -drag v, on top of the springs
  std::span<const double> spring_coefficient;  ///< per spring: impulse per rate of elongation, N s / (m/s)
  const StabilizerSystem* stabilizers = nullptr;
  double stabilizer_stiffness_share = 0, stabilizer_damping_share = 0;  ///< of their matrices, s^2 and s
};

/// result = B v, the impulses that oppose v: springs and stabilisers, without drag.
void damping_impulses(const VelocitySystem& system, const Positions& direction, const Positions& v, Positions& result,
                      Positions& scratch);

/// Solves (I + dt drag) v + M^-1 B v = rhs for v, where B is damping_impulses(), on the rows with inverse mass > 0; the
/// other rows of v are given and kept. v holds the first guess.
/// Multiplied by M the matrix is symmetric positive definite, so conjugate gradients with the diagonal as
/// preconditioner apply. Ends when the residual is 1e-9 of the right-hand side, in the norm of the preconditioner, or
/// after 200 iterations. Then the impulses B v of the solution are applied to rhs: they are equal and opposite, so
/// what is left of the residual is an error in damping alone, and momenta are kept to rounding. Returns the number of
/// iterations. Deterministic for any thread count.
std::int32_t solve_velocity(const VelocitySystem& system, const Positions& direction, const Positions& rhs, double dt_s,
                            Positions& v);

}  // namespace selvage::sim
