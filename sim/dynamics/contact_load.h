// What contacts bear, from one step of the dynamics to the next.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace selvage::sim {

/// What a pair bears: the next step of the dynamics begins with it.
struct ContactLoad {
  std::int32_t first, second;                ///< vertex and face, or edges
  double acceleration_m_s2;                  ///< of the pair's relative motion, > 0
  std::array<double, 3> friction_m_s2 = {};  ///< of the same, across the contact's direction, if the pair did not turn
};

/// Of all contacts; each list is sorted by first and second.
/// Vertices on faces: one sweep passes a weight on by one contact only, so that ten sheets that lay on one another,
/// held as if the stack were new in every step, lost a third of their height within a second, in five times as many
/// steps. Without their friction eight sheets walked sideways by 0.6 mm a second, by 0.02 with it
/// (docs/simulator-speed.md). Edges: dynamics that sweep leave none, as cloth over the edge of a box, where edges
/// remembered as well, crept by 0.7 mm a second (0.02 without; HeldContacts::hold() says why vertices go first). Those
/// that solve for what contacts bear begin nearer to the solution with them: cloth at rest on cloth takes a quarter to
/// a tenth of the Newton rounds (docs/numerics.md).
struct ContactLoads {
  std::vector<ContactLoad> vf, ee;

  [[nodiscard]] bool empty() const { return vf.empty() && ee.empty(); }
};

}  // namespace selvage::sim
