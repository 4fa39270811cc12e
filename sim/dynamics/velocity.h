// The velocity at the end of a step when damping is implicit (paper, section 7.6), by conjugate gradients.
#pragma once

#include <span>
#include <vector>

#include "sim/springs/spring_lanes.h"

namespace selvage::sim {

struct VelocitySystem {
  SpringLanes& springs;
  const LaneVectors& x;  ///< what they looked at last
  std::span<const double> inverse_mass;
  double drag_1_s = 0;  ///< acceleration -drag v, on top of the springs
};

/// Ends when the residual, in the norm of the preconditioner, is this part of the damping impulses, or of the momentum.
/// What is left is an error of damping, or of what stands in B for springs that move within the step. Measured on a
/// frame of the folded curtain (150 x 150, 79 steps): against 1e-9 velocities change by 1.8 mm/s (root of the mean
/// square), against steps half as long by 25, of 2.2 m/s.
inline constexpr double kVelocityResidual = 1e-2;

/// Solves (I + dt drag) v + M^-1 B v = rhs for v, where B is that of the springs, on the rows with inverse mass > 0;
/// the other rows of v are given and kept. Multiplied by M the matrix is symmetric positive definite, so conjugate
/// gradients with the diagonal as preconditioner apply. The impulses of the solution are summed up along the way and
/// applied to rhs: they are sums of equal and opposite ones, so momenta are kept to rounding whatever is left of the
/// residual. Weak stabilisers (stabilizer_lanes.h) oppose the first guess in place of v. Deterministic for any thread
/// count.
class VelocitySolver {
 public:
  /// `impulses` holds a guess at B v, which zero is; it becomes B v. Returns the number of iterations, at most 200.
  std::int32_t solve(const VelocitySystem& system, const LaneVectors& rhs, double dt_s, LaneVectors& impulses,
                     LaneVectors& v);

 private:
  /// Squared norms, the preconditioner's.
  struct Norms {
    double residual = 0, impulses = 0, momentum = 0;
    Norms& operator+=(const Norms& other);
  };
  Norms begin(const VelocitySystem& system, const LaneVectors& rhs, double dt_s, LaneVectors& impulses, LaneVectors& v);

  LaneVectors residual_, step_, product_;  // of momenta, of v, B step_
  LaneVectors inverse_diagonal_;           // zero in rows that are given
  std::vector<Norms> partial_norms_;       // room for sums
  std::vector<double> partial_;
};

}  // namespace selvage::sim
