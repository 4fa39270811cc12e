// The step that a campaign must find out: it says safe of every candidate.
#pragma once

#include "fuzz/oracle/step_oracle.h"

namespace selvage::fuzz {

inline sim::CollisionStepResult nothing_done(const StepWorld& world, const Positions& x_t0,
                                             const Positions& candidate) {
  sim::CollisionStepResult result;
  result.report.status = sim::StepStatus::kSafe;
  result.x = candidate;
  result.velocity = (candidate - x_t0) / world.dt_s;
  return result;
}

}  // namespace selvage::fuzz
