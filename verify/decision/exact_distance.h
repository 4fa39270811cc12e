// Exact comparison of the distance of two features, at one instant or over a motion, with a given double.
#pragma once

#include <array>

#include "verify/decision/exact_motion.h"

namespace selvage::verify {

/// Sign of (distance - d): -1 closer than d, 0 exactly d, 1 farther. REQUIRES d >= 0, finite.
[[nodiscard]] int compare_vf_distance(const std::array<Point, 4>& x, double d);
[[nodiscard]] int compare_ee_distance(const std::array<Point, 4>& x, double d);

/// A point and a triangle, or two edges.
struct FeaturePair {
  bool is_vf = true;
  std::array<Point, 4> x{};
};
/// -1, 0, 1: the features of a are nearer to each other than those of b, exactly as far, farther. REQUIRES finite
/// points.
[[nodiscard]] int compare_distances(const FeaturePair& a, const FeaturePair& b);

/// Whether the features come within d (closed) at the time t in [0,1] of the straight motion; exact for any double t.
[[nodiscard]] bool vf_within_at(const std::array<Point, 4>& x_t0, const std::array<Point, 4>& x_t1, double t, double d);
[[nodiscard]] bool ee_within_at(const std::array<Point, 4>& x_t0, const std::array<Point, 4>& x_t1, double t, double d);

}  // namespace selvage::verify
