// The fail-safe: what still collides is held back until nothing does (S1). In ordinary scenes it has nothing to do.
//
// Each cloth vertex has a restraint, which only grows:
//   kFree     as the response left it;
//   kLimited  in a ball about V_t0 whose radius is kBallShare of a proved lower bound on the distance from every
//             feature of the vertex to every other feature at t = 0: two limited vertices' features cannot meet;
//   kFrozen   x = V_t0: a pair that does not move cannot touch, V_t0 being free of intersections;
//   kCarried  moved with a scripted body by that body's rigid motion: nothing that moves so can meet the body; with one
//             that deforms by the motion of the features that it would have met.
// A pair that still collides raises every cloth vertex of it that it can raise by one level: the lowest ones, and
// carried only where a moving body takes part. Where none can be raised, bodies collide with something that cannot give
// way, and the scene's policy has to decide. So each round raises a vertex or ends: at most 3 #V + 1 rounds.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "sim/base/blockage.h"
#include "sim/response/blocked_bodies.h"
#include "sim/response/collision_tracker.h"
#include "sim/response/scripted_groups.h"

namespace selvage::sim {

enum class Restraint : std::uint8_t { kFree, kLimited, kFrozen, kCarried };

/// Two features of which all vertices stay within half of their distance cannot meet; a quarter leaves them half of it,
/// far from the kernel's error bounds. Rounding to the lattice can at most double a displacement that is smaller than
/// its spacing; what then still collides is frozen in the next round.
inline constexpr double kBallShare = 0.25;
static_assert(kBallShare < 0.5);

/// #V: a proved lower bound on the distance at V from every feature that holds v to every feature that it must not
/// meet, at most `reach`; computed for flagged vertices, `reach` for the others.
[[nodiscard]] std::vector<double> clearance(const Mesh& mesh, BoxHierarchy& hierarchy, const PositionsRef& V,
                                            double reach, std::span<const std::uint8_t> flagged);

class StepLimiter {
 public:
  /// Collisions in which nothing can be held back.
  struct Conflict {
    Collision collision;              ///< the first
    std::vector<GroupId> groups;      ///< that move in it, and in those that have none of these; not empty
    std::vector<VertexId> vertices;   ///< scripted ones that move in any of them, or carry what is in it
    std::vector<Blockage> blockages;  ///< in all of them
  };

  /// `reach`: how far clearances are looked for; a limited vertex moves at most kBallShare of it.
  StepLimiter(const Mesh& mesh, BoxHierarchy& hierarchy, const ScriptedGroups& groups, double reach);

  /// Restrains vertices of every collision that is not proved free of touch. Nothing where there was a conflict.
  [[nodiscard]] std::optional<Conflict> restrain(const CollisionTracker& tracker, StepMotion& motion);
  /// Cloth vertices that are restrained, sorted.
  [[nodiscard]] std::vector<VertexId> restrained() const;

 private:
  struct Restrained {
    Restraint level = Restraint::kFree;
    GroupId carrier = ScriptedGroups::kCloth;
    std::array<VertexId, 4> met{};  ///< where it is carried: a pair in which the carrier takes part itself
  };
  /// Levels and carriers are those at the start of the round, so that the order of pairs does not matter.
  [[nodiscard]] Restrained at_start_of_round(VertexId vertex, const std::vector<std::uint8_t>& raised) const;
  [[nodiscard]] std::array<Mover, 4> movers(const std::array<VertexId, 4>& pair,
                                            const std::vector<std::uint8_t>& raised) const;
  /// Those of their groups that move.
  [[nodiscard]] std::vector<GroupId> moving_groups(const std::array<Mover, 4>& movers) const;
  /// The pair, or, where the carrier is in it by what it carries alone, the pair that this met.
  [[nodiscard]] std::array<VertexId, 4> met_by(GroupId carrier, const std::array<VertexId, 4>& pair,
                                               const std::vector<std::uint8_t>& raised) const;
  /// Whether anything was raised.
  bool raise(const std::array<VertexId, 4>& pair, const std::vector<GroupId>& moving,
             std::vector<std::uint8_t>& raised);
  void place(const std::vector<std::uint8_t>& raised, StepMotion& motion);

  const Mesh& mesh_;
  BoxHierarchy& hierarchy_;
  const ScriptedGroups& groups_;
  double reach_;
  std::vector<Restrained> state_;  ///< #V
};

}  // namespace selvage::sim
