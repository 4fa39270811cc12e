// The scripted vertices of a scene in a step: where they go, and which of them have to stand still (S4).
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "sim/scene/scene.h"
#include "sim/time_step.h"
#include "sim/world.h"

namespace selvage::sim {

class ScriptedMotion {
 public:
  /// Both must outlive this.
  ScriptedMotion(const Scene& scene, const World& world) : scene_(scene), world_(world) {}

  /// A step begins, in which nothing had to wait yet.
  void start_step();
  /// x, with the vertices that are scripted now where their scripts are at the end of the step, or on their way there.
  [[nodiscard]] Positions follow(const Positions& x, const StepClock& clock);
  /// Bodies that had to wait in a try are known before the next one, which starts from the same state: so the dynamics
  /// sees them stand still. Where it saw them move, cloth took up a motion that never was: pinched between two spheres
  /// that stood it came to 70 m/s.
  void stand_still(std::span<const VertexId> waiting);
  /// Who stands still in the step: bodies and vertices, as in CollisionStepReport.
  [[nodiscard]] std::pair<std::vector<std::int32_t>, std::vector<VertexId>> waiting() const;

  /// #V, 1/kg, in the last motion; 0 for scripted vertices.
  [[nodiscard]] const std::vector<double>& inverse_mass() const { return scripted_.inverse_mass; }
  [[nodiscard]] bool is_scripted(VertexId vertex) const {
    return inverse_mass()[static_cast<std::size_t>(vertex)] == 0;
  }
  [[nodiscard]] CollisionBodies bodies() const { return bodies_of(world_, scripted_, scene_.squeeze); }

 private:
  void follow(const Collider& collider, const Positions& x_t0, const StepClock& clock, Positions& x) const;

  const Scene& scene_;
  const World& world_;
  ScriptedVertices scripted_;
  std::vector<std::uint8_t> waits_;  ///< #V
};

}  // namespace selvage::sim
