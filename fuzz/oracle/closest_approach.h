// Whether two moving features ever come within a given distance: the exact side of promise K3.
#pragma once

#include <cstdint>
#include <span>

#include "fuzz/base/motion_query.h"

namespace selvage::fuzz {

enum class Approach : std::uint8_t {
  kWithin,   ///< PROVED: at some double time in [0,1] the distance is at most d
  kBeyond,   ///< PROVED: at every real time in [0,1] the distance is greater than d
  kUnknown,  ///< the smallest distance is too close to d for the number of tests allowed
};

/// Enough to bisect down to neighbouring doubles about one closest approach; a hint decides nearly always before.
inline constexpr int kEnoughTests = 256;

/// Both proofs are exact comparisons of the distance at single times. Between them, the distance of two features
/// changes at most as fast as their fastest pair of vertices moves apart (each point of a feature is a convex
/// combination of its vertices), so `distance(m) > d + speed r` excludes every time within r of m. Bisects, nearest
/// interval first; `hints` are tried before anything else. At most `max_tests` exact comparisons.
[[nodiscard]] Approach closest_approach(const MotionQuery& query, double d, std::span<const double> hints,
                                        int max_tests);

/// The distance at time t, rounded: no proof may rest on it.
[[nodiscard]] double rounded_distance(const MotionQuery& query, double t);

/// Upper bound on the relative speed (length a step) of the features' vertices.
[[nodiscard]] double relative_speed_upper(const MotionQuery& query);

}  // namespace selvage::fuzz
