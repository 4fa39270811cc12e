// Where bodies cannot go on, as cloth has no room (S4).
#pragma once

#include <cstdint>

#include "kernel/types.h"

namespace selvage::sim {

/// What is blocked may not move against `direction`: a rigid body at `at_m`, or one vertex of a body that deforms.
struct Blockage {
  static constexpr VertexId kWholeBody = -1;

  std::int32_t body;  ///< the caller's
  VertexId vertex;    ///< or kWholeBody
  Vec3 at_m;          ///< at the start of the step
  Vec3 direction;     ///< a unit vector, away from what is in the way
  friend bool operator==(const Blockage&, const Blockage&) = default;
};

}  // namespace selvage::sim
