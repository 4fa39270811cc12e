// Who moves by script: every body is a group that moves, or waits, as a whole, or vertex by vertex where it deforms.
// Scripted vertices without a body (pins in the cloth) form one group more.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sim/base/rigid_motion.h"
#include "sim/contact/collision_bodies.h"
#include "sim/response/step_motion.h"

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
  [[nodiscard]] std::int32_t body(GroupId group) const { return at(group).body; }

  [[nodiscard]] bool deforms(GroupId group) const { return at(group).deforms; }
  /// And no pin.
  [[nodiscard]] bool is_body(GroupId group) const { return at(group).is_body; }

  /// Makes vertices keep their start positions for this step: all of the rigid ones of `groups`, and those of
  /// `vertices` that belong to any group that deforms; where all of these wait, all of `groups`. Asserts that one at
  /// least did not wait till now: what calls it until nothing is in the way ends.
  void wait(std::span<const GroupId> groups, std::span<const VertexId> vertices);
  [[nodiscard]] bool waits(VertexId vertex) const { return waits_[static_cast<std::size_t>(vertex)] != 0; }
  /// The caller's bodies of which a vertex waits, sorted.
  [[nodiscard]] std::vector<std::int32_t> waiting_bodies() const;
  /// Sorted.
  [[nodiscard]] std::vector<VertexId> waiting_vertices() const;
  /// V_candidate with the rows of waiting vertices at V_t0.
  [[nodiscard]] Positions targets(const PositionsRef& V_t0, const PositionsRef& V_candidate) const;

  /// Finds out which groups move in `motion`. To be called when a motion starts.
  void observe(const StepMotion& motion);
  [[nodiscard]] bool moves(GroupId group) const { return at(group).moves; }
  /// The rigid motion that the group's own motion is, or is nearest to; of one that deforms, to the motion of those of
  /// `near` that belong to it, at least one. No motion for a group at rest.
  [[nodiscard]] RigidMotion rigid_motion(GroupId group, const StepMotion& motion, std::span<const VertexId> near) const;

 private:
  struct Group {
    std::int32_t body;
    std::vector<VertexId> vertices;
    bool is_body = false;
    bool deforms = false;
    bool moves = false;
  };
  [[nodiscard]] const Group& at(GroupId group) const { return groups_[static_cast<std::size_t>(group)]; }

  std::vector<GroupId> group_;       ///< #V
  std::vector<std::uint8_t> waits_;  ///< #V
  std::vector<Group> groups_;        ///< bodies by number, then the pins
};

}  // namespace selvage::sim
