#include "sim/record/body_waits.h"

#include <algorithm>

namespace selvage::sim {

void add_waits(const Simulation& simulation, const StepResult& step, BodyWaits& waits) {
  const Precision precision = simulation.scene().collision.precision;
  const double now_s = simulation.clock().time_s();
  for (const std::int32_t id : step.report.waiting_bodies) {
    const Collider& body = simulation.world().colliders[static_cast<std::size_t>(id)];
    const Positions placed = simulation.x()(body.vertices(), Eigen::all);
    auto wait = std::ranges::lower_bound(waits, id, {}, &BodyWait::collider);
    if (wait == waits.end() || wait->collider != id) wait = waits.insert(wait, {id, 0, now_s - step.dt_s, now_s, 0});
    ++wait->steps;
    wait->end_s = now_s;
    const double lag_m = (body.placed_at(now_s, precision, simulation.x()) - placed).rowwise().norm().maxCoeff();
    wait->largest_lag_m = std::max(wait->largest_lag_m, lag_m);
  }
}

}  // namespace selvage::sim
