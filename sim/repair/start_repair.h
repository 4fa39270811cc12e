// What makes a start that intersects one that does not: moved apart (untangle.h), then eased where that has strained
// it (relax_springs.h).
#pragma once

#include <vector>

#include "sim/repair/untangle.h"
#include "sim/step.h"

namespace selvage::sim {

struct RepairedStart {
  Positions x;                      ///< of the simulation, where pairs remain
  std::vector<FacePair> remaining;  ///< as in UntangleReport
  std::int64_t moved_vertices = 0;  ///< in the end
  double largest_move_m = 0;
  std::int32_t rounds = 0;       ///< states that were judged
  std::int32_t relax_steps = 0;  ///< in which strained cloth was eased
  double largest_strain = 0;     ///< after them (spring_strain.h)
};

/// Of the state that the simulation is in, at time 0. Nothing rubs meanwhile; a part of the cloth that was not moved
/// apart from anything keeps its bits. `find` as for untangle(). Deterministic, if that is.
[[nodiscard]] RepairedStart repair_start(const Simulation& simulation, const FindIntersections& find);

}  // namespace selvage::sim
