// Random meshes in motion for the broad phase: lattice positions, so that boxes touch exactly, with nudges of one unit
// in the last place; scales from subnormal to huge; soups, grids and several components; loose vertices.
#pragma once

#include <optional>
#include <ostream>
#include <vector>

#include "kernel/candidates.h"

namespace selvage::testing {

struct RandomShape {
  VertexId vertex_count = 0;
  Faces F;
};

/// One motion of a shape, and what is asked of it.
struct RandomMotion {
  Positions V_t0, V_t1;
  double reach = 0;
  std::vector<std::uint8_t> active;
  MotionBoxes boxes = MotionBoxes::kSwept;

  [[nodiscard]] CandidateOptions options() const { return {reach, active, boxes}; }
};

/// To be called inside a RapidCheck property. Small cases come first and failures shrink.
RandomShape random_shape();
RandomMotion random_motion(VertexId vertex_count);

std::ostream& operator<<(std::ostream& out, const RandomShape& shape);
std::ostream& operator<<(std::ostream& out, const RandomMotion& motion);  ///< hex floats

}  // namespace selvage::testing
