// Which bodies had to wait for the cloth (squeeze = "yield"), when, and how far behind their scripts that left them.
#pragma once

#include <map>

#include "sim/step.h"

namespace selvage::cli {

class WaitingSummary {
 public:
  /// After every step of the simulation that was taken.
  void add(const sim::Simulation& simulation, const sim::StepResult& step);
  /// A line for each that waited, on standard output.
  void print(const sim::World& world) const;

 private:
  struct Wait {
    std::int64_t steps = 0;
    double begin_s = 0, end_s = 0;  ///< of the first and of the last of them
    double largest_lag_m = 0;       ///< at their ends
  };
  std::map<std::int32_t, Wait> waits_;  ///< by collider
};

}  // namespace selvage::cli
