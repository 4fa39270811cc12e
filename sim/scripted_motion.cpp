#include "sim/scripted_motion.h"

#include <set>

#include "sim/bodies/catch_up.h"

namespace selvage::sim {

void ScriptedMotion::start_step() { waits_.assign(static_cast<std::size_t>(world_.x_t0.rows()), 0); }

// First the bodies, then the pins, which may hang on them.
Positions ScriptedMotion::follow(const Positions& x, const StepClock& clock) {
  scripted_ = scripted_at(world_, clock.time_s());
  Positions x_t1 = x;
  for (const Collider& collider : world_.colliders) {
    if (collider.holds(clock.time_s())) follow(collider, x, clock, x_t1);
  }
  return x_t1;
}

void ScriptedMotion::follow(const Collider& collider, const Positions& x_t0, const StepClock& clock,
                            Positions& x) const {
  const bool float32 = scene_.collision.precision == CollisionOptions::Precision::kFloat32;
  const std::vector<VertexId>& vertices = collider.vertices();
  Positions script_t1 = collider.placed_at(clock.end_s(), float32, x);
  if (scene_.squeeze == SqueezePolicy::kYield) {  // else none has ever waited
    const Positions now = x_t0(vertices, Eigen::all), script_t0 = collider.placed_at(clock.time_s(), float32, x_t0);
    if (now != script_t0) {
      const double least_speed_m_s = scene_.collision.thickness_m / kCatchUpTime_s;
      const auto catch_script = collider.deforms() ? catch_up_each : catch_up;
      script_t1 = catch_script(now, script_t0, script_t1, clock.dt_s(), least_speed_m_s);
    }
  }
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    if (waits_[static_cast<std::size_t>(vertices[i])] == 0)
      x.row(vertices[i]) = script_t1.row(static_cast<Eigen::Index>(i));
  }
}

void ScriptedMotion::stand_still(std::span<const VertexId> waiting) {
  for (const VertexId v : waiting) waits_[static_cast<std::size_t>(v)] = 1;
}

std::pair<std::vector<std::int32_t>, std::vector<VertexId>> ScriptedMotion::waiting() const {
  std::set<std::int32_t> bodies;
  std::vector<VertexId> vertices;
  for (VertexId v = 0; v < static_cast<VertexId>(waits_.size()); ++v) {
    if (waits_[static_cast<std::size_t>(v)] == 0) continue;
    bodies.insert(scripted_.body[static_cast<std::size_t>(v)]);
    vertices.push_back(v);
  }
  return {std::vector<std::int32_t>(bodies.begin(), bodies.end()), std::move(vertices)};
}

}  // namespace selvage::sim
