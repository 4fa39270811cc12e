// Which vertices of a mesh are cloth, bodies and pins, and what happens where cloth cannot avoid these.
#pragma once

#include <cstdint>
#include <limits>
#include <span>

namespace selvage::sim {

/// What to do where cloth cannot avoid scripted bodies (S4).
enum class SqueezePolicy : std::uint8_t {
  kStop,   ///< return kStopped with a witness; nothing is advanced
  kYield,  ///< the bodies involved wait, or the vertices involved of those that deform: they keep their positions for
           ///< this step
};

struct CollisionBodies {
  /// #V: inverse masses in 1/kg; 0 for scripted vertices, which follow their candidate positions exactly.
  std::span<const double> inverse_mass;
  /// #V: body that a scripted vertex belongs to, -1 for cloth. A body moves, or waits, as a whole. Empty: no bodies.
  std::span<const std::int32_t> body = {};
  SqueezePolicy policy = SqueezePolicy::kStop;
  /// The bodies from this one on are pins: what they hold is cloth, even a part of the mesh of which they hold all.
  std::int32_t first_pin = std::numeric_limits<std::int32_t>::max();
  /// By body, shorter where the others do not: 1 where its motion is no rigid one. It waits vertex by vertex, and cloth
  /// that has to move with it moves with what it meets.
  std::span<const std::uint8_t> deforms = {};
};

}  // namespace selvage::sim
