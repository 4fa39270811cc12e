// The other filter of exact_distance: cheap proofs that two features are within a given distance.
#pragma once

#include <array>

#include "verify/arithmetic/point.h"

namespace selvage::verify {

/// x = {p, a, b, c}. True is a proof that the point is within d (closed) of the closed triangle; false means "do not
/// know", as always where the distance is d. Valid for all finite input in the environment of FpGuard.
[[nodiscard]] bool triage_vf_nearer(const std::array<Point, 4>& x, double d);
/// x = {a, b, c, d}: closed edge (a, b) against closed edge (c, d).
[[nodiscard]] bool triage_ee_nearer(const std::array<Point, 4>& x, double d);

}  // namespace selvage::verify
