#include "sim/response/scripted_groups.h"

#include <algorithm>
#include <map>
#include <optional>

#include "kernel/assert.h"

namespace selvage::sim {

ScriptedGroups::ScriptedGroups(const CollisionBodies& bodies)
    : group_(bodies.inverse_mass.size(), kCloth), waits_(group_.size(), 0) {
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
    const bool deforms = body && static_cast<std::size_t>(*body) < bodies.deforms.size() &&
                         bodies.deforms[static_cast<std::size_t>(*body)] != 0;
    const bool is_body = body && *body < bodies.first_pin;
    groups_.push_back({body.value_or(-1), std::move(vertices), is_body, deforms});
  }
}

Positions ScriptedGroups::targets(const PositionsRef& V_t0, const PositionsRef& V_candidate) const {
  Positions result = V_candidate;
  for (Eigen::Index v = 0; v < result.rows(); ++v) {
    if (waits(static_cast<VertexId>(v))) result.row(v) = V_t0.row(v);
  }
  return result;
}

void ScriptedGroups::wait(std::span<const GroupId> groups, std::span<const VertexId> vertices) {
  bool any = false;
  const auto wait_one = [&](VertexId v) {
    any = any || !waits(v);
    waits_[static_cast<std::size_t>(v)] = 1;
  };
  for (const VertexId v : vertices) {
    if (is_scripted(v) && at(group(v)).deforms) wait_one(v);
  }
  for (const GroupId id : groups) {
    if (!at(id).deforms) std::ranges::for_each(at(id).vertices, wait_one);
  }
  if (any) return;
  for (const GroupId id : groups) std::ranges::for_each(at(id).vertices, wait_one);
  SELVAGE_ASSERT(any);
}

std::vector<std::int32_t> ScriptedGroups::waiting_bodies() const {
  std::vector<std::int32_t> bodies;
  for (const Group& group : groups_) {
    if (std::ranges::any_of(group.vertices, [&](VertexId v) { return waits(v); })) bodies.push_back(group.body);
  }
  std::ranges::sort(bodies);
  return bodies;
}

std::vector<VertexId> ScriptedGroups::waiting_vertices() const {
  std::vector<VertexId> vertices;
  for (VertexId v = 0; v < static_cast<VertexId>(waits_.size()); ++v) {
    if (waits(v)) vertices.push_back(v);
  }
  return vertices;
}

void ScriptedGroups::observe(const StepMotion& motion) {
  for (Group& group : groups_) {
    group.moves = std::ranges::any_of(group.vertices, [&](VertexId v) { return motion.moves(v); });
  }
}

RigidMotion ScriptedGroups::rigid_motion(GroupId id, const StepMotion& motion, std::span<const VertexId> near) const {
  const Group& group = at(id);
  if (!group.moves) return {};
  std::vector<Vec3> x_t0, x_t1;
  for (const VertexId v : group.deforms ? near : std::span<const VertexId>(group.vertices)) {
    if (this->group(v) != id) continue;
    x_t0.emplace_back(motion.V_t0().row(v));
    x_t1.emplace_back(motion.x().row(v));
  }
  SELVAGE_ASSERT(!x_t0.empty());
  return best_fit_motion(x_t0, x_t1);
}

}  // namespace selvage::sim
