// Which springs would end a step too long or too short, for several at once (SIMD, chosen at run time).
#pragma once

#include <cstdint>
#include <vector>

#include "sim/base/lane_table.h"
#include "sim/springs/spring.h"

namespace selvage::sim {

/// The structural and shear springs of a system: the limits of section 4 do not look at bending springs.
class LengthCheck {
 public:
  explicit LengthCheck(const SpringSystem& springs);  ///< not needed later on

  enum class Reference : std::uint8_t { kRestLength, kLengthNow };

  /// Sets is_outside[spring] to 1 for those whose length at x_t1 is not within 1 - share and 1 + share of the
  /// reference, to 0 for all others; to 2^-46 of the reference. A length that is not a number is outside.
  void find_outside(const LaneVectors& x_t0, const LaneVectors& x_t1, Reference reference, double share,
                    std::vector<std::uint8_t>& is_outside) const;

 private:
  LaneTable table_;  ///< each spring once, at its first end
  std::vector<double> rest_squared_m2_;
};

}  // namespace selvage::sim
