// One motion of a mesh as a case of the kernel's whole-mesh answer: broad phase, lanes and queries together.
#pragma once

#include <cstdint>
#include <vector>

#include "fuzz/kept/mesh_case.h"
#include "kernel/mesh.h"

namespace selvage::fuzz {

[[nodiscard]] const MeshKind& collisions_kind();

/// `active`: #V flags, or empty: all.
[[nodiscard]] MeshCase collisions_case(const Mesh& mesh, const Positions& x_t0, const Positions& x_t1, double tolerance,
                                       const std::vector<std::uint8_t>& active);

struct CollisionsTrial {
  std::int64_t pairs = 0;   ///< judged: all of the mesh that have an active vertex
  std::int64_t alarms = 0;  ///< answered as not separated
  Retrial retrial;
};
/// Finds the collisions of the motion, listed and visited, and judges the answer to every pair by exact arithmetic.
[[nodiscard]] CollisionsTrial try_collisions(const MeshCase& kept);

}  // namespace selvage::fuzz
