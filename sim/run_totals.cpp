#include "sim/run_totals.h"

#include <algorithm>

namespace selvage::sim {

void RunTotals::add(const StepResult& step) {
  const CollisionStepReport& report = step.report;
  ++steps;
  halvings += step.halvings;
  proximities += report.proximities;
  repulsions += report.repulsions;
  frictions += report.frictions;
  steps_with_collisions += report.impulse_rounds + report.zone_rounds + report.fail_safe_rounds > 0 ? 1 : 0;
  first_collisions += report.first_collisions;
  impulse_rounds += report.impulse_rounds;
  zone_rounds += report.zone_rounds;
  largest_zone_vertices = std::max<std::int64_t>(largest_zone_vertices, report.largest_zone);
  fail_safe_rounds += report.fail_safe_rounds;
  fail_safe_vertices += report.fail_safe_vertices;
  pairs_below_tolerance += static_cast<std::int64_t>(report.below_tolerance.size());
  waiting_bodies += static_cast<std::int64_t>(report.waiting_bodies.size());
  dynamics_s += step.seconds.dynamics;
  collision_s += step.seconds.collision;
  velocity_s += step.seconds.velocity;
}

}  // namespace selvage::sim
