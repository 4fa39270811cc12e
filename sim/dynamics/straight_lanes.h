// Contacts in lanes on bodies that go straight on (straight_surface.h): which way they repel, eight at once.
#pragma once

#include <array>

#include "sim/contact/straight_surface.h"
#include "sim/dynamics/contact_pack.h"

namespace selvage::sim {

/// What is straight of the bodies in a pack (straight_surface.h), at both ends of the collision step.
struct PackStraight {
  struct Part {
    LaneMask lines = 0, planes = 0;
    LaneColumn3 direction_t0{}, direction_t1{};
    std::array<LaneColumn<double>, 2> extents_m{};
  };
  std::array<Part, 3> parts;        ///< as in StraightFeature
  std::array<LaneMask, 2> edges{};  ///< whose body is the first, and the second edge
};

void set_straight(PairKind kind, const StraightFeature& feature, const Positions& V_t0, const Positions& V_t1,
                  std::size_t lane, PackStraight& pack);

/// Directions as across() has them `share` in [0, 1] into the step, and the distances along them. The lanes whose
/// points are beyond what is straight.
[[nodiscard]] LaneMask turn_across(const PackStraight& straight, double share, PackNearest& nearest);

}  // namespace selvage::sim
