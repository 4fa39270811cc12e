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

/// result = B v, the impulses that oppose v: springs and stabilisers, without drag. Row i is the sum over the springs s
/// at i of coefficient[s] n_s n_s^T (v_i - v_other), and the same with the stabilisers' coefficients and no direction:
/// the product with a symmetric positive semidefinite matrix whose rows sum to zero.
void damping_impulses(const VelocitySystem& system, const Positions& direction, const Positions& v, Positions& result);

/// Ends when the residual, in the norm of the preconditioner, is this part of the impulses B rhs that damping would
/// have without any change of velocity, or this part of the momentum of rhs. What is left is an error of damping alone.
/// Chosen, not measured: a hundred thousandth of a force whose coefficient nobody knows to a hundredth.
inline constexpr double kVelocityResidual = 1e-5;

/// Solves (I + dt drag) v + M^-1 B v = rhs for v, where B is damping_impulses(), on the rows with inverse mass > 0; the
/// other rows of v are given and kept. Multiplied by M the matrix is symmetric positive definite, so conjugate
/// gradients with the diagonal as preconditioner apply; the first guess is the velocity without damping. The impulses
/// of the solution are summed up along the way and applied to rhs: they are sums of equal and opposite ones, so momenta
/// are kept to rounding whatever is left of the residual. Deterministic for any thread count.
class VelocitySolver {
 public:
  /// Returns the number of iterations, at most 200.
  std::int32_t solve(const VelocitySystem& system, const Positions& direction, const Positions& rhs, double dt_s,
                     Positions& v);
  /// Of the last solution: rows of B v.
  [[nodiscard]] const Positions& impulses() const { return impulses_; }

 private:
  struct Sums {
    double energy, limit;
  };
  Sums begin(const VelocitySystem& system, const Positions& direction, const Positions& rhs, double dt_s,
             const Positions& fixed_v);

  Positions guess_, impulses_;           // B v is impulses_ all along
  Positions residual_, step_, product_;  // of momenta, of v, B step_
  Positions inverse_diagonal_;
  std::vector<double> partial_;  // room for sums
};

}  // namespace selvage::sim
