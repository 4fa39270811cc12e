#include "sim/scripted_groups.h"

#include <algorithm>
#include <map>
#include <optional>

namespace selvage::sim {

ScriptedGroups::ScriptedGroups(const CollisionBodies& bodies) : group_(bodies.inverse_mass.size(), kCloth) {
  using Owner = std::optional<std::int32_t>;
  const auto before = [](const Owner& a, const Owner& b) { return a && (!b || *a < *b); };  // the pins after every body
  std::map<Owner, std::vector<VertexId>, decltype(before)> members(before);
  for (std::size_t v = 0; v < group_.size(); ++v) {
    if (bodies.inverse_mass[v] > 0) continue;
    const bool has_body = !bodies.body.empty() && bodies.body[v] >= 0;
    members[has_body ? Owner(bodies.body[v]) : std::nullopt].push_back(static_cast<VertexId>(v));
  }
  for (auto& [body, vertices] : members) {
    for (const VertexId v : vertices) group_[static_cast<std::size_t>(v)] = count();
    groups_.push_back({body.value_or(-1), std::move(vertices)});
  }
}

Positions ScriptedGroups::targets(const PositionsRef& V_t0, const PositionsRef& V_candidate) const {
  Positions result = V_candidate;
  for (const Group& group : groups_) {
    if (!group.waits) continue;
    for (const VertexId v : group.vertices) result.row(v) = V_t0.row(v);
  }
  return result;
}

void ScriptedGroups::observe(const StepMotion& motion) {
  for (Group& group : groups_) {
    group.moves = std::ranges::any_of(group.vertices, [&](VertexId v) { return motion.moves(v); });
  }
}

RigidMotion ScriptedGroups::rigid_motion(GroupId id, const StepMotion& motion) const {
  const Group& group = groups_[static_cast<std::size_t>(id)];
  if (!group.moves) return {};
  std::vector<Vec3> x_t0, x_t1;
  for (const VertexId v : group.vertices) {
    x_t0.emplace_back(motion.V_t0().row(v));
    x_t1.emplace_back(motion.x().row(v));
  }
  return best_fit_motion(x_t0, x_t1);
}

}  // namespace selvage::sim
