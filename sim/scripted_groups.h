// Who moves by script: every body is a group that moves, or waits, as a whole. Scripted vertices without a body (pins
// in the cloth) form one group more.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "sim/collision_step.h"
#include "sim/rigid_motion.h"
#include "sim/step_motion.h"

namespace selvage::sim {

using GroupId = std::int32_t;

class ScriptedGroups {
 public:
  static constexpr GroupId kCloth = -1;

  explicit ScriptedGroups(const CollisionBodies& bodies);

  [[nodiscard]] GroupId count() const { return static_cast<GroupId>(groups_.size()); }
  [[nodiscard]] GroupId group(VertexId vertex) const { return group_[static_cast<std::size_t>(vertex)]; }
  [[nodiscard]] bool is_scripted(VertexId vertex) const { return group(vertex) != kCloth; }
  /// The caller's body, or -1 for the pins.
  [[nodiscard]] std::int32_t body(GroupId group) const { return groups_[static_cast<std::size_t>(group)].body; }

  /// Makes a group keep its start positions for this step.
  void wait(GroupId group) { groups_[static_cast<std::size_t>(group)].waits = true; }
  [[nodiscard]] bool waits(GroupId group) const { return groups_[static_cast<std::size_t>(group)].waits; }
  /// V_candidate with the rows of waiting groups at V_t0.
  [[nodiscard]] Positions targets(const PositionsRef& V_t0, const PositionsRef& V_candidate) const;

  /// Finds out which groups move in `motion`. To be called when a motion starts.
  void observe(const StepMotion& motion);
  [[nodiscard]] bool moves(GroupId group) const { return groups_[static_cast<std::size_t>(group)].moves; }
  /// The rigid motion that the group's own motion is, or is nearest to; no motion for a group at rest.
  [[nodiscard]] RigidMotion rigid_motion(GroupId group, const StepMotion& motion) const;

 private:
  struct Group {
    std::int32_t body;
    std::vector<VertexId> vertices;
    bool waits = false;
    bool moves = false;
  };
  std::vector<GroupId> group_;  ///< #V
  std::vector<Group> groups_;   ///< bodies by number, then the pins
};

}  // namespace selvage::sim
