#include "sim/repair/approach_start.h"

namespace selvage::sim {
namespace {

constexpr int kApproachSteps = 12;   // each goes half of what is left
constexpr double kLeastGain = 1e-3;  // of the way: a step that gains less ends the approach

}  // namespace

void approach_start(UntangleState& state) {
  std::vector<double> inverse_mass(state.bodies.inverse_mass.begin(), state.bodies.inverse_mass.end());
  CollisionBodies bodies = state.bodies;
  bodies.inverse_mass = inverse_mass;
  for (VertexId v = 0; v < state.mesh.vertex_count; ++v) {
    if (state.x.row(v) == state.V.row(v)) inverse_mass[static_cast<std::size_t>(v)] = 0;
  }
  CollisionStep step = state.make_step();
  double left = (state.x - state.V).norm();
  for (int n = 0; n < kApproachSteps && left > 0; ++n) {
    Positions candidate = state.x;
    for (VertexId v = 0; v < state.mesh.vertex_count; ++v) {
      if (!(inverse_mass[static_cast<std::size_t>(v)] > 0)) continue;
      const Vec3 here = state.x.row(v), there = state.V.row(v);
      candidate.row(v) = here + (there - here) / 2;
    }
    const CollisionStepResult result = step(state.x, candidate, bodies, kRepairStep_s);
    if (result.report.status != StepStatus::kSafe) return;
    const double now_left = (result.x - state.V).norm();
    if (!(now_left < (1 - kLeastGain) * left)) return;
    state.x = result.x;
    left = now_left;
  }
}

}  // namespace selvage::sim
