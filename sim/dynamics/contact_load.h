// What contacts bear, from one step of the dynamics to the next: their warm start.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "kernel/mesh.h"
#include "kernel/types.h"

namespace selvage::sim {

/// What a pair bears: the next step of the dynamics begins with it.
struct ContactLoad {
  std::int32_t first, second;                ///< vertex and face, or edges
  double acceleration_m_s2;                  ///< of the pair's relative motion, > 0
  std::array<double, 3> friction_m_s2 = {};  ///< of the same, across the contact's direction, if the pair did not turn
  friend bool operator==(const ContactLoad&, const ContactLoad&) = default;
};

/// Of all contacts; each list is sorted by first and second.
/// Vertices on faces: one sweep passes a weight on by one contact only, so that ten sheets that lay on one another,
/// held as if the stack were new in every step, lost a third of their height within a second, in five times as many
/// steps. Without their friction eight sheets walked sideways by 0.6 mm a second, by 0.02 with it
/// (docs/measurements/simulator-speed.md). Edges: under dynamics that sweep only where all four vertices can move, as
/// cloth over the edge of a box, where such edges remembered as well, crept by 0.7 mm a second (0.02 without;
/// SweptContacts::hold() says why vertices go first). While those of cloth on cloth remembered nothing either, a sheet
/// on another on a slope well within the cone of friction crept by 54 mm in a minute. Those that solve for what
/// contacts bear begin nearer to the solution with them: cloth at rest on cloth takes a quarter to a tenth of the
/// Newton rounds (docs/measurements/numerics.md).
struct ContactLoads {
  std::vector<ContactLoad> vf, ee;

  [[nodiscard]] bool empty() const { return vf.empty() && ee.empty(); }
  friend bool operator==(const ContactLoads&, const ContactLoads&) = default;
};

/// That of the pair; else that of the vertex on a face that shares a corner. Over an edge or a corner of the surface a
/// vertex lies on any of the faces there, and another may have been found than the one that bore it. Several may begin
/// with one load: what is too much they take back. Null where there is none. O(log loads + those of `first`).
[[nodiscard]] const ContactLoad* find_load(const ContactLoads& loads, PairKind kind, std::int32_t first,
                                           std::int32_t second, const Mesh& mesh);

/// Sorts them as ContactLoads has them. A pair that collided while it was held is held twice; what both bear, the first
/// does, and the other takes back.
void keep_one_of_each_pair(std::vector<ContactLoad>& loads);

}  // namespace selvage::sim
