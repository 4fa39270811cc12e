#include "cli/answer/waiting_summary.h"

#include <algorithm>

#include <fmt/format.h>

#include "io/text.h"

namespace selvage::cli {

void WaitingSummary::add(const sim::Simulation& simulation, const sim::StepResult& step) {
  const bool float32 = simulation.scene().collision.precision == sim::CollisionOptions::Precision::kFloat32;
  const double now_s = simulation.clock().time_s();
  for (const std::int32_t id : step.report.waiting_bodies) {
    const sim::Collider& body = simulation.world().colliders[static_cast<std::size_t>(id)];
    const Positions placed = simulation.x()(body.vertices(), Eigen::all);
    const auto [wait, is_first] = waits_.try_emplace(id);
    if (is_first) wait->second.begin_s = now_s - step.dt_s;
    ++wait->second.steps;
    wait->second.end_s = now_s;
    const double lag_m = (body.placed_at(now_s, float32, simulation.x()) - placed).rowwise().norm().maxCoeff();
    wait->second.largest_lag_m = std::max(wait->second.largest_lag_m, lag_m);
  }
}

void WaitingSummary::print(const sim::World& world) const {
  for (const auto& [id, wait] : waits_) {
    fmt::print("\"{}\" waited in {} steps from {:.4g} to {:.4g} s, up to {:.3g} m behind its script\n",
               io::printable(world.colliders[static_cast<std::size_t>(id)].name()), wait.steps, wait.begin_s,
               wait.end_s, wait.largest_lag_m);
  }
}

}  // namespace selvage::cli
