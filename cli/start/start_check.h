// The start of a simulation: decided exactly, repaired if asked for, refused if it intersects.
#pragma once

#include "sim/record/run_totals.h"

namespace selvage::cli {

/// S1 begins with an intersection-free state. Where the start intersects, says on stderr which faces do. With `repair`
/// the cloth is moved apart (sim/repair/untangle.h) and what was done is said; throws io::Error where pairs remain, and
/// without `repair`.
sim::StartRepair require_clean_start(sim::Simulation& simulation, bool repair);

}  // namespace selvage::cli
