// The velocity at the end of a step when damping is implicit (paper, section 7.6), by conjugate gradients, for several
// vertices at once (SIMD, chosen at run time).
#pragma once

#include <vector>

#include "sim/springs/spring_lanes.h"

namespace selvage::sim {

struct VelocitySystem {
  SpringLanes& springs;
  const LaneVectors& x;  ///< what they looked at last
  const LaneScalars& inverse_mass;
  double drag_1_s = 0;  ///< acceleration -drag v, on top of the springs
};

/// Ends when the residual, in the norm of the preconditioner, is this part of the damping impulses, or of the momentum.
/// What is left is an error of damping, or of what stands in B for springs that move within the step. Measured on the
/// curtain (150 x 150) over a frame of 80 steps from 0.4, 2.133 and 3.633 s: against 1e-9 positions end up 25, 2 and 9
/// micrometres away (root of the mean square), 8, 0 and 5 with 1e-2; 281, 134 and 77 with steps half as long. Most
/// solutions take one iteration, and with 1e-2 two.
inline constexpr double kVelocityResidual = 5e-2;

/// Squared norms, the preconditioner's.
struct SolutionNorms {
  double residual = 0, impulses = 0, momentum = 0;
  SolutionNorms& operator+=(const SolutionNorms& other);
};

/// Where a solution has come to.
struct SolutionVectors {
  LaneVectors &residual, &step, &product;  ///< of momenta; of v; B step
  LaneVectors& inverse_diagonal;           ///< zero in rows that are given
  LaneVectors& impulses;                   ///< B v
};

/// Solves (I + dt drag) v + M^-1 B v = rhs for v, where B is that of the springs, on the rows with inverse mass > 0;
/// the other rows of v are given and kept. Multiplied by M the matrix is symmetric positive definite, so conjugate
/// gradients with the diagonal as preconditioner apply. The impulses of the solution are summed up along the way and
/// applied to rhs: they are sums of equal and opposite ones, so momenta are kept to rounding whatever is left of the
/// residual. Weak stabilisers (stabilizer_lanes.h) oppose the first guess in place of v. Same bits for any thread
/// count and vector unit.
class VelocitySolver {
 public:
  /// `impulses` holds a guess at B v, which zero is; it becomes B v. Returns the number of iterations, at most 200.
  std::int32_t solve(const VelocitySystem& system, const LaneVectors& rhs, double dt_s, LaneVectors& impulses,
                     LaneVectors& v, double residual = kVelocityResidual);

 private:
  LaneVectors residual_, step_, product_, inverse_diagonal_;  // as in SolutionVectors
  std::vector<SolutionNorms> partial_norms_;                  // room for sums
  std::vector<double> partial_;
};

}  // namespace selvage::sim
