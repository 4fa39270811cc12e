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
  std::vector<std::uint8_t> is_body(world.triangles.size());
  for (const io::Group& group : world.groups) {
    for (FaceId f = group.face_begin; f < group.face_end; ++f) {
      is_body[static_cast<std::size_t>(f)] = group.role == io::Group::Role::kBody;
    }
  }
  const verify::Surface surface{world.triangles, is_body};
  return verify::check_frame(surface, sim::points_of(x_t1), {}).violations_total.total() +
         verify::check_motion(surface, sim::points_of(x_t0), sim::points_of(x_t1), {}).violations_total.total();
}

}  // namespace selvage::testing
