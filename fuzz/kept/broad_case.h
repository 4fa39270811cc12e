// Two motions of one mesh as a case of the broad phase: the second is found by hierarchies that have seen the first.
#pragma once

#include "fuzz/draw/step_world.h"
#include "fuzz/kept/mesh_case.h"

namespace selvage::fuzz {

[[nodiscard]] const MeshKind& broad_kind();

/// Which pairs of one of the motions are asked for.
struct BroadQuestion {
  double reach = 0;
  std::vector<std::uint8_t> active;  ///< #V, or empty: all
};
[[nodiscard]] MeshCase broad_case(const Mesh& mesh, const std::array<Positions, 3>& x,
                                  const std::array<BroadQuestion, 2>& questions);

struct BroadTrial {
  std::int64_t pairs = 0;  ///< found by brute force
  Retrial retrial;
};
[[nodiscard]] BroadTrial try_broad(const MeshCase& kept);

}  // namespace selvage::fuzz
