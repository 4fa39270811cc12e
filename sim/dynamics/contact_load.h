// What contacts bear, from one step of the dynamics to the next.
#pragma once

#include <array>
#include <cstdint>

namespace selvage::sim {

/// What a vertex bears on a face: the next step of the dynamics begins with it. One sweep passes a weight on by one
/// contact only, so that ten sheets that lay on one another, held as if the stack were new in every step, lost a third
/// of their height within a second, in five times as many steps. Without its friction eight sheets walked sideways by
/// 0.6 mm a second, by 0.02 with it (docs/simulator-speed.md). Edges have none: where they remembered as well, cloth
/// over the edge of a box crept by 0.7 mm a second (0.02 without; HeldContacts::hold() says why vertices go first).
struct ContactLoad {
  std::int32_t vertex, face;
  double acceleration_m_s2;                  ///< of the pair's relative motion, > 0
  std::array<double, 3> friction_m_s2 = {};  ///< of the same, across the contact's direction, if the pair did not turn
};

}  // namespace selvage::sim
