// The judge of proximities (K4): the kernel's bracket against exact distances.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "fuzz/base/motion_query.h"

namespace selvage::fuzz {

enum class ProximityDefect : std::uint8_t {
  kNone,
  kLowerTooHigh,  ///< the exact distance is less than distance_lower
  kUpperTooLow,   ///< the exact distance is more than distance_upper
  kOutside,       ///< distance is not within its own bracket, or not a number
  kTooWide,       ///< distance_upper is far above distance_lower: a bracket that says nothing
  kBadWeights,    ///< not convex, or their points are farther apart than distance_upper
  kBadErrorBound  ///< point_error_bound is below sqrt(upper^2 - lower^2)
};
[[nodiscard]] std::string_view name_of(ProximityDefect defect);

struct ProximityJudgement {
  ProximityDefect defect = ProximityDefect::kNone;
  bool exactly_zero = false;  ///< the features touch
  double width = 0;           ///< (upper - lower) / largest corner distance: how sharp the bracket is
};

/// Asks vf_proximity or ee_proximity. REQUIRES kind kVf or kEe.
[[nodiscard]] ProximityJudgement judge_proximity(PairKind kind, const std::array<Vec3, 4>& x);

}  // namespace selvage::fuzz
