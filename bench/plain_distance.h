// Distances of features in plain doubles, without a bound on their error: what additive_ccd.h stands on.
// Source: Ericson, Real-Time Collision Detection (2005), sections 5.1.5 and 5.1.9.
#pragma once

#include <array>

#include "kernel/types.h"

namespace selvage::bench {

/// x = {p, a, b, c}: point p to triangle (a, b, c).
[[nodiscard]] double plain_vf_distance(const std::array<Vec3, 4>& x);
/// x = {a, b, c, d}: edge (a, b) to edge (c, d).
[[nodiscard]] double plain_ee_distance(const std::array<Vec3, 4>& x);

}  // namespace selvage::bench
