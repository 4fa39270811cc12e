#include "sim/response/step_limit.h"

#include <algorithm>
#include <optional>

#include "kernel/assert.h"
#include "kernel/proximities.h"
#include "sim/base/sorted_once.h"

namespace selvage::sim {
std::vector<double> clearance(const Mesh& mesh, BoxHierarchy& hierarchy, const PositionsRef& V, double reach,
                              std::span<const std::uint8_t> flagged) {
  std::vector<double> result(flagged.size(), reach);
  const auto lower_to = [&](VertexId v, double distance_lower) {
    double& value = result[static_cast<std::size_t>(v)];
    if (flagged[static_cast<std::size_t>(v)] != 0) value = std::min(value, distance_lower);
  };
  for (const PairProximity& pair : find_proximities(mesh, hierarchy, V, reach, flagged)) {
    for (const VertexId v : pair.vertices) lower_to(v, pair.proximity.distance_lower);
  }
  for (const auto& face : mesh.faces) {
    if (std::ranges::none_of(face, [&](VertexId v) { return flagged[static_cast<std::size_t>(v)] != 0; })) continue;
    const std::array<Vec3, 3> x{V.row(face[0]), V.row(face[1]), V.row(face[2])};
    for (std::size_t k = 0; k < 3; ++k) {
      const Proximity self = self_proximity({x[k], x[(k + 1) % 3], x[(k + 2) % 3]});
      for (const VertexId v : face) lower_to(v, self.distance_lower);
    }
  }
  return result;
}

StepLimiter::StepLimiter(const Mesh& mesh, BoxHierarchy& hierarchy, const ScriptedGroups& groups, double reach)
    : mesh_(mesh),
      hierarchy_(hierarchy),
      groups_(groups),
      reach_(reach),
      state_(static_cast<std::size_t>(mesh.vertex_count)) {}

std::vector<VertexId> StepLimiter::restrained() const {
  std::vector<VertexId> result;
  for (VertexId v = 0; v < mesh_.vertex_count; ++v) {
    if (state_[static_cast<std::size_t>(v)].level != Restraint::kFree) result.push_back(v);
  }
  return result;
}

StepLimiter::Restrained StepLimiter::at_start_of_round(VertexId vertex, const std::vector<std::uint8_t>& raised) const {
  const auto v = static_cast<std::size_t>(vertex);
  if (raised[v] == 0) return state_[v];
  return {static_cast<Restraint>(static_cast<int>(state_[v].level) - 1), ScriptedGroups::kCloth, {}};
}

std::array<Mover, 4> StepLimiter::movers(const std::array<VertexId, 4>& pair,
                                         const std::vector<std::uint8_t>& raised) const {
  std::array<Mover, 4> result;
  std::ranges::transform(pair, result.begin(), [&](VertexId v) -> Mover {
    const Restrained own = at_start_of_round(v, raised);
    if (own.level == Restraint::kCarried) return {own.carrier, own.met};
    return {groups_.group(v), {v, v, v, v}};
  });
  return result;
}

std::vector<GroupId> StepLimiter::moving_groups(const std::array<Mover, 4>& movers) const {
  std::vector<GroupId> result;
  for (const Mover& mover : movers) {
    if (mover.group != ScriptedGroups::kCloth && groups_.moves(mover.group)) result.push_back(mover.group);
  }
  keep_sorted_once(result);
  return result;
}

std::array<VertexId, 4> StepLimiter::met_by(GroupId carrier, const std::array<VertexId, 4>& pair,
                                            const std::vector<std::uint8_t>& raised) const {
  if (std::ranges::any_of(pair, [&](VertexId v) { return groups_.group(v) == carrier; })) return pair;
  const auto* carried =
      std::ranges::find_if(pair, [&](VertexId v) { return at_start_of_round(v, raised).carrier == carrier; });
  SELVAGE_ASSERT(carried != pair.end());  // else it does not move in the pair
  return at_start_of_round(*carried, raised).met;
}

bool StepLimiter::raise(const std::array<VertexId, 4>& pair, const std::vector<GroupId>& moving,
                        std::vector<std::uint8_t>& raised) {
  Restraint lowest = Restraint::kCarried;
  bool meets_rest = false;
  for (const VertexId v : pair) {
    if (groups_.is_scripted(v)) {
      meets_rest = meets_rest || !groups_.moves(groups_.group(v));
    } else {
      lowest = std::min(lowest, at_start_of_round(v, raised).level);
    }
  }
  const bool can_carry = moving.size() == 1 && !meets_rest;
  if (lowest == Restraint::kCarried || (lowest == Restraint::kFrozen && !can_carry)) return false;
  const std::array<VertexId, 4> met = lowest == Restraint::kFrozen ? met_by(moving.front(), pair, raised) : pair;
  for (const VertexId vertex : pair) {
    const auto v = static_cast<std::size_t>(vertex);
    if (groups_.is_scripted(vertex) || raised[v] != 0 || state_[v].level != lowest) continue;
    state_[v].level = static_cast<Restraint>(static_cast<int>(lowest) + 1);
    if (state_[v].level == Restraint::kCarried) {
      state_[v].carrier = moving.front();
      state_[v].met = met;
    }
    raised[v] = 1;
  }
  return true;
}

void StepLimiter::place(const std::vector<std::uint8_t>& raised, StepMotion& motion) {
  std::vector<std::uint8_t> limited(raised.size(), 0);
  for (std::size_t v = 0; v < raised.size(); ++v) {
    limited[v] = raised[v] != 0 && state_[v].level == Restraint::kLimited ? 1 : 0;
  }
  const bool any_limited = std::ranges::any_of(limited, [](std::uint8_t flag) { return flag != 0; });
  std::vector<double> free_distance;
  if (any_limited) free_distance = clearance(mesh_, hierarchy_, motion.V_t0(), reach_, limited);
  std::vector<std::optional<RigidMotion>> rigid(static_cast<std::size_t>(groups_.count()));
  const auto carry = [&](const Restrained& carried) {
    std::optional<RigidMotion>& carrier = rigid[static_cast<std::size_t>(carried.carrier)];
    if (!carrier || groups_.deforms(carried.carrier)) {
      carrier = groups_.rigid_motion(carried.carrier, motion, carried.met);
    }
    return *carrier;
  };
  for (VertexId vertex = 0; vertex < mesh_.vertex_count; ++vertex) {
    const auto v = static_cast<std::size_t>(vertex);
    if (raised[v] == 0) continue;
    const Vec3 start = motion.V_t0().row(vertex);
    if (state_[v].level == Restraint::kLimited) {
      const Vec3 displacement = motion.displacement().row(vertex);
      const double length = displacement.stableNorm();
      const double radius = kBallShare * free_distance[v];
      if (length > radius) motion.move(vertex, displacement * (radius / length));
    } else if (state_[v].level == Restraint::kFrozen) {
      motion.freeze(vertex);
    } else {
      motion.move(vertex, carry(state_[v]).displacement(start));
    }
  }
}

std::optional<StepLimiter::Conflict> StepLimiter::restrain(const CollisionTracker& tracker, StepMotion& motion) {
  std::vector<std::uint8_t> raised(state_.size(), 0);
  std::optional<Conflict> conflict;
  for (const Collision& collision : tracker.collisions()) {
    if (collision.ccd.cause == CcdCause::kEnd) continue;
    const std::array<VertexId, 4> pair = tracker.vertices(collision);
    const std::array<Mover, 4> movers = this->movers(pair, raised);
    const std::vector<GroupId> moving = moving_groups(movers);
    if (raise(pair, moving, raised)) continue;
    SELVAGE_ASSERT(!moving.empty());  // else all four vertices are frozen, and the tracker drops such pairs
    if (!conflict) conflict = Conflict{collision, {}, {}, {}};
    add_blockages(collision, pair, movers, groups_, motion, conflict->blockages);
    // All conflicts that share no group wait at once: one after the other 160 of them took 36 s. What shares a group
    // with these may find room when they wait.
    const auto is_named = [&](GroupId group) {
      return std::ranges::find(conflict->groups, group) != conflict->groups.end();
    };
    if (std::ranges::none_of(moving, is_named)) {
      conflict->groups.insert(conflict->groups.end(), moving.begin(), moving.end());
    }
    for (const Mover& mover : movers) {
      for (const VertexId v : mover.vertices) {
        if (groups_.is_scripted(v) && motion.moves(v)) conflict->vertices.push_back(v);
      }
    }
  }
  if (!conflict) place(raised, motion);
  return conflict;
}

}  // namespace selvage::sim
