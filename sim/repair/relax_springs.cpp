#include "sim/repair/relax_springs.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "kernel/fp_env.h"
#include "sim/dynamics/implicit_dynamics.h"
#include "sim/springs/spring_strain.h"

namespace selvage::sim {
namespace {

// Steps of 1/30 and 1/480 s take twice and four times as many for two sheets of 60 N/m that a repair stretched to 3.5
// times their length (measured).
constexpr double kStep_s = 1.0 / 120;
// Where much is stretched, a step may meet so much that it stretches more; but after some the sum must have gone down.
constexpr std::int32_t kMaxInVain = 5;
constexpr double kLeastRelief = 1e-3;  // of the sum; less is no reason to go on

/// Of structural and shear springs, what they are longer or shorter by beyond the limit, over their lengths, summed up.
double excess(const SpringSystem& springs, const PositionsRef& x, double strain_limit) {
  double sum = 0;
  for (const Spring& spring : springs.springs()) {
    if (spring.kind == SpringKind::kBending) continue;
    sum += std::max(0.0, std::abs(elongation(spring, x)) - strain_limit);
  }
  return sum;
}

}  // namespace

RelaxedSprings relax_springs(const Positions& x, const SpringSystem& springs, const StabilizerSystem* stabilizers,
                             CollisionStep& collision_step, const CollisionBodies& bodies, double strain_limit) {
  const FpEnvGuard guard;
  const Eigen::Index cloth = springs.vertex_count();
  ImplicitDynamicsOptions options;
  options.strain.strain = 0;
  options.step_s = kStep_s;
  options.stabilizers = stabilizers;
  ImplicitDynamics dynamics(springs, options);
  RelaxedSprings result{x};
  Positions now = x;
  double least = excess(springs, x.topRows(cloth), strain_limit);
  for (std::int32_t n = 1; least > 0 && n <= std::min(result.steps + kMaxInVain, kMaxRelaxSteps); ++n) {
    Motion motion{now.topRows(cloth), Positions::Zero(cloth, 3)};
    Positions candidate = now;
    (void)dynamics.advance(motion, now.topRows(cloth), bodies.inverse_mass, kStep_s);
    candidate.topRows(cloth) = motion.x;
    CollisionStepResult safe = collision_step(now, candidate, bodies, kStep_s);
    if (safe.report.status != StepStatus::kSafe) break;
    now = std::move(safe.x);
    const double left = excess(springs, now.topRows(cloth), strain_limit);
    if (!(left < (1 - kLeastRelief) * least)) continue;
    least = left;
    result.x = now;
    result.steps = n;
  }
  result.largest_strain = most_strained(springs, result.x.topRows(cloth)).strain;
  return result;
}

}  // namespace selvage::sim
