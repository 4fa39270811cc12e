// A cull for whole lists of candidates, one pair a lane (SIMD, chosen at run time; same decisions on every target).
// It asks the question of cull.h in float32, with simpler bounds: the points themselves are projected, and errors are
// relative to the size of the mesh, not to the pair. What it leaves is asked again, with bounds relative to the pair.
#pragma once

#include "kernel/lanes/lane_motion.h"

namespace selvage::detail {

/// The places of those `pairs` that are not PROVED free of touch in [0,1] and farther apart than `tolerance` at t = 1,
/// ascending. REQUIRES motion.is_valid(), pairs of its mesh, a finite tolerance >= 0, and the environment of
/// FpEnvGuard.
void cull_in_lanes(const LaneMotion& motion, const LanePairs& pairs, double tolerance, PairNumbers& left);

}  // namespace selvage::detail
