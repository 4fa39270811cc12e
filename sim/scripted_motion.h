// The scripted vertices of a scene in a step: where they go, and which of them are kept from their scripts (S4).
#pragma once

#include <cstdint>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "sim/bodies/blocked_ways.h"
#include "sim/collision_step.h"
#include "sim/scene/scene.h"
#include "sim/step_clock.h"
#include "sim/world.h"

namespace selvage::sim {

class ScriptedMotion {
 public:
  /// Both must outlive this.
  ScriptedMotion(const Scene& scene, const World& world);

  /// A step begins, in which nothing had to wait yet.
  void start_step(double time_s);
  /// It is taken.
  void end_step(double dt_s) { blocked_.end_step(dt_s); }
  /// How the bodies that may come near cloth move in a step, the worst of them. Bent: one leaves the straight lines on
  /// which the step takes its vertices by more than the thickness of their contacts, the least of them, so that what it
  /// passes on its way would not be met, or turns so far that it may come back to where it was. Uneven: it keeps to its
  /// lines, but is farther than that from where the dynamics have it meanwhile (Passage), so that it would meet cloth
  /// at the wrong time and speed. x, v: of cloth, at least.
  enum class Way { kAsSeen, kUneven, kBent };
  [[nodiscard]] Way way(const Positions& x, const Positions& v, const StepClock& clock) const;
  /// x, with the vertices that are scripted now where their scripts are at the end of the step, or on their way there.
  [[nodiscard]] Positions follow(const Positions& x, const StepClock& clock);
  /// How bodies leave the straight lines of the last motion: halfway through the step a vertex is a quarter of its row
  /// away from the middle of its line, m (Passage). #V less those of cloth by 3; null where no body does. 0 for those
  /// that wait, or are not where their scripts have them.
  [[nodiscard]] const Positions* bow_m() const { return bow_m_.isZero(0) ? nullptr : &bow_m_; }
  /// Who had to wait in a try is known before the next one, which starts from the same state: so the dynamics sees it
  /// stand still. Where it saw it move, cloth took up a motion that never was: pinched between two spheres that stood
  /// it came to 70 m/s. Bodies try to go on along what blocks them before they stand still.
  void wait(const CollisionStepReport& report);
  /// Who is kept from its script in the step: bodies and vertices, as in CollisionStepReport.
  [[nodiscard]] std::pair<std::vector<std::int32_t>, std::vector<VertexId>> waiting() const;

  /// What lasts from step to step.
  [[nodiscard]] const std::vector<BlockedWay>& blocked_ways() const { return blocked_.all(); }
  void restore(const std::vector<BlockedWay>& blocked) { blocked_.restore(blocked); }

  /// #V, 1/kg, in the last motion; 0 for scripted vertices.
  [[nodiscard]] const std::vector<double>& inverse_mass() const { return scripted_.inverse_mass; }
  [[nodiscard]] bool is_scripted(VertexId vertex) const {
    return inverse_mass()[static_cast<std::size_t>(vertex)] == 0;
  }
  [[nodiscard]] CollisionBodies bodies() const { return bodies_of(world_, scripted_, scene_.squeeze); }

 private:
  /// Of the contacts of a body with all cloth.
  struct Thickness {
    double least_m, most_m;
  };
  [[nodiscard]] Thickness thickness_with_cloth(const Collider& collider,
                                               const std::set<std::int32_t>& cloth_surfaces) const;
  /// Of its path in a step of dt_s, with and without gravity.
  [[nodiscard]] Eigen::AlignedBox3d box_of_cloth(const Positions& x, const Positions& v, double dt_s) const;
  void follow(const Collider& collider, const Positions& x_t0, const StepClock& clock, Positions& x);
  /// Whether anything blocks the collider on its way from x_t0 to x_t1, rows of its own, which is led round it then.
  bool lead_round(const Collider& collider, const Positions& x_t0, double dt_s, Positions& x_t1);
  void set_bow(const Collider& collider, const StepClock& clock);

  const Scene& scene_;
  const World& world_;
  std::vector<Thickness> thickness_;                  ///< by collider
  std::vector<std::vector<std::size_t>> carried_by_;  ///< likewise: the pins that hang on it
  ScriptedVertices scripted_;
  std::vector<std::uint8_t> waits_;  ///< #V
  BlockedWays blocked_;
  std::vector<std::uint8_t> is_led_;  ///< #V: round what blocks it, in the last motion
  Positions bow_m_;
};

}  // namespace selvage::sim
