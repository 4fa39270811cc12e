// Which bodies had to wait for the cloth (squeeze = "yield"), when, and how far behind their scripts that left them.
#pragma once

#include <cstdint>
#include <vector>

#include "sim/step.h"

namespace selvage::sim {

struct BodyWait {
  std::int64_t collider = 0, steps = 0;
  double begin_s = 0, end_s = 0;  ///< of the first and of the last of them
  double largest_lag_m = 0;       ///< at their ends
};

/// By collider.
using BodyWaits = std::vector<BodyWait>;

/// After every step of the simulation that was taken.
void add_waits(const Simulation& simulation, const StepResult& step, BodyWaits& waits);

}  // namespace selvage::sim
