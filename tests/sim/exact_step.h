// The exact verdict on the steps of a simulation.
#pragma once

#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "sim/base/points.h"
#include "sim/step.h"
#include "verify/check.h"

namespace selvage::testing {

/// Of the frame x_t1, and of the motion that led to it.
inline std::int64_t violations(const sim::World& world, const Positions& x_t0, const Positions& x_t1) {
  const std::vector<std::uint8_t> is_body = io::body_faces(world.triangles.size(), world.groups);
  const verify::Surface surface{world.triangles, is_body};
  return verify::check_frame(surface, sim::points_of(x_t1), {}).violations_total.total() +
         verify::check_motion(surface, sim::points_of(x_t0), sim::points_of(x_t1), {}).violations_total.total();
}

/// Goes to frame `end`; every step is safe and exactly free, or fails the test, and look(step) follows it.
template <class Look>
void run_exactly_free(sim::Simulation& simulation, std::int64_t end, const Look& look) {
  while (simulation.clock().frame() < end) {
    const Positions before = simulation.x();
    const sim::StepResult step = simulation.step();
    ASSERT_EQ(step.report.status, sim::StepStatus::kSafe);
    EXPECT_EQ(violations(simulation.world(), before, simulation.x()), 0) << simulation.clock().time_s() << " s";
    look(step);
  }
}

}  // namespace selvage::testing
