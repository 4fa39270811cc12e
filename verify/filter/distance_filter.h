// The filter of exact_distance: cheap proofs that two features are farther apart than a given distance.
#pragma once

#include <array>

#include "verify/arithmetic/point.h"

namespace selvage::verify {

/// x = {p, a, b, c}. True is a proof that the point is farther than d from the closed triangle; false means "do not
/// know". Valid for all finite input in the environment of FpGuard.
[[nodiscard]] bool triage_vf_farther(const std::array<Point, 4>& x, double d);
/// x = {a, b, c, d}: closed edge (a, b) against closed edge (c, d).
[[nodiscard]] bool triage_ee_farther(const std::array<Point, 4>& x, double d);

/// An estimate of the distance, >= 0, that proves nothing.
[[nodiscard]] double estimate_vf_distance(const std::array<Point, 4>& x);
[[nodiscard]] double estimate_ee_distance(const std::array<Point, 4>& x);

}  // namespace selvage::verify
