// What tests of whole scenes share.
#pragma once

#include <string>

#include "sim/step.h"

namespace selvage::sim::testing {

inline std::string plane() {
  return "[[body]]\nname = \"plane\"\nsheet = {nx = 2, ny = 2, width_m = 4, height_m = 4}\n";
}

inline Vec3 mean(const Positions& rows, VertexId begin, VertexId end) {
  return rows.middleRows(begin, end - begin).colwise().mean().transpose();
}

/// Steps until then; where everything is.
inline const Positions& run_to(Simulation& simulation, double end_s) {
  while (simulation.clock().time_s() < end_s - 1e-9) simulation.step();
  return simulation.x();
}

}  // namespace selvage::sim::testing
