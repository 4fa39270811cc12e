// The exact verdict on one step of a simulation.
#pragma once

#include <cstdint>
#include <vector>

#include "sim/points.h"
#include "sim/world.h"
#include "verify/check.h"

namespace selvage::testing {

/// Of the frame x_t1, and of the motion that led to it.
inline std::int64_t violations(const sim::World& world, const Positions& x_t0, const Positions& x_t1) {
  const std::vector<std::uint8_t> is_body = io::body_faces(world.triangles.size(), world.groups);
  const verify::Surface surface{world.triangles, is_body};
  return verify::check_frame(surface, sim::points_of(x_t1), {}).violations_total.total() +
         verify::check_motion(surface, sim::points_of(x_t0), sim::points_of(x_t1), {}).violations_total.total();
}

}  // namespace selvage::testing
