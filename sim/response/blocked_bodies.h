// What a collision in which nothing can give way says of the bodies in it (S4).
#pragma once

#include <array>
#include <vector>

#include "kernel/collisions.h"
#include "sim/base/blockage.h"
#include "sim/response/scripted_groups.h"
#include "sim/response/step_motion.h"

namespace selvage::sim {

/// What moves a vertex of a colliding pair.
struct Mover {
  GroupId group = ScriptedGroups::kCloth;  ///< that it belongs to, or that carries it; kCloth: none
  std::array<VertexId, 4> vertices{};      ///< itself, four times; or the pair that the cloth met which is carried
};

/// Adds what blocks each body that moves against what it meets, along the normal of the collision: a rigid one where
/// its side of the pair is, of one that deforms each vertex that takes part. Nothing of pins, and where the collision
/// has no normal. movers[i]: of pair[i].
void add_blockages(const Collision& collision, const std::array<VertexId, 4>& pair, const std::array<Mover, 4>& movers,
                   const ScriptedGroups& groups, const StepMotion& motion, std::vector<Blockage>& blockages);

}  // namespace selvage::sim
