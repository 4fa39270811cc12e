#include "sim/record/run_totals.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "sim/base/keep_largest.h"
#include "sim/response/travel_limit.h"

namespace selvage::sim {

void RunTotals::add(const StepResult& step) {
  const CollisionStepReport& report = step.report;
  ++steps;
  halvings += step.halvings;
  proximities += report.proximities;
  repulsions += report.repulsions;
  frictions += report.frictions;
  steps_with_collisions += report.collided() ? 1 : 0;
  first_collisions += report.first_collisions;
  impulse_rounds += report.impulse_rounds;
  zone_rounds += report.zone_rounds;
  largest_zone_vertices = std::max<std::int64_t>(largest_zone_vertices, report.largest_zone);
  fail_safe_rounds += report.fail_safe_rounds;
  fail_safe_vertices += report.fail_safe_vertices;
  pairs_below_tolerance += static_cast<std::int64_t>(report.below_tolerance.size());
  waiting_bodies += static_cast<std::int64_t>(report.waiting_bodies.size());
  cut_candidates += report.cut_candidates;
  bent_steps += step.is_bent ? 1 : 0;
  dynamics_solves += step.dynamics.solves;
  newton_rounds += step.dynamics.newton_rounds;
  cg_iterations += step.dynamics.cg_iterations;
  unconverged_solves += step.dynamics.unconverged;
  keep_largest(step.dynamics.residual_m, largest_residual_m);
  if (step.most_strained.strain > largest_strain) {
    largest_strain = step.most_strained.strain;
    largest_strain_at_s = step.end_s;
    largest_strain_from = step.most_strained.ends[0];
    largest_strain_to = step.most_strained.ends[1];
  }
  phases += step.phases;
}

PhaseTime RunTotals::all() const {
  PhaseTime sum = recording;
  for (const PhaseTime& time : std::array{phases.dynamics, phases.collision, phases.velocity}) sum += time;
  return sum;
}

std::string RunTotals::shortfalls() const {
  std::string text;
  const auto add_clause = [&](std::int64_t count, const std::string& what) {
    if (count > 0) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, what);
  };
  if (repair.largest_strain > kTornStrain) {
    text = fmt::format("--repair left cloth at {:.2g} times its length", 1 + repair.largest_strain);
  }
  add_clause(fail_safe_vertices, "vertices were held back by the fail-safe");
  add_clause(pairs_below_tolerance, "pairs ended a step nearer than the tolerance");
  add_clause(waiting_bodies, "times a body waited");
  add_clause(
      cut_candidates,
      fmt::format("times a vertex was cut back: it went farther in a step than {} diagonals of the scene, or the "
                  "step met too many pairs",
                  kMaxTravel));
  add_clause(bent_steps, "steps were too long for a body that turns or turns back within them");
  add_clause(unconverged_solves, "implicit solves did not converge");
  return text;
}

}  // namespace selvage::sim
