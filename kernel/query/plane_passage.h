// The origin passes through the plane of the difference polygon: inside the polygon, the features pass through each
// other; outside, they pass beside. Nearly every query that the cull leaves is one of the two, and plain doubles tell.
//   The coplanarity cubic is looked at over the step, then over halves, quarters and so on: over each part it has no
//   root, or one root that is then placed within a short interval, or the part is halved. All of it is certified, by
//   the same bounds as the search (ccd_search.h), to which everything else is left.
#pragma once

#include <array>
#include <vector>

#include "kernel/arithmetic/time_ticks.h"
#include "kernel/lanes/lane_motion.h"
#include "kernel/query/pair_motion.h"

namespace selvage::detail {

/// Plain doubles place a contact within so many ticks: toi_lower is early by at most 2^-36 of the step. The root
/// intervals of 99.9 % of the contacts of a public cloth frame are below 2^12 ticks, half of them below 2^7.
inline constexpr Tick kShortWidth = Tick{1} << 16;
/// A contact this deep inside the polygon within a short interval around a sign change of the cubic is a real one: the
/// polygon's height is at least this, so that its frame is well-conditioned, depth is good to 2^-50, and nothing moves
/// farther than 2^-33 within the interval.
inline constexpr double kInnerDepth = 0x1p-20;
/// An alarm is raised only with a witness this near, relative to the largest difference (in [0.5, 1) after scaling).
/// One tick is left uncertified only if the gap in it is of the order of the rounding of one support, 3 kSupportError,
/// plus the motion within one tick, 2^-51: below 2^-48. The rest is room for directions that are not optimal.
inline constexpr double kAlarmGap = 0x1p-40;

enum class Passage : std::uint8_t {
  kUnclear,
  kSeparated,  ///< PROVED: no touch in [0,1]
  kContact,    ///< a touch within kShortWidth after `tick`; PROVED: none before it
};

struct PlanePassage {
  Passage passage = Passage::kUnclear;
  std::int32_t intervals = 0;  ///< looked at: the step, at most 30 parts of it, and at most one root in each 16th
  // Of a contact:
  Tick tick = 0;
  double gap = 0;  ///< PROVED: the features come within it at `tick`, scaled; at most kAlarmGap
  std::array<double, 4> weights = {};
  Double3 normal;  ///< unit, up to rounding, from the second feature to the first before the touch
};

/// REQUIRES kind kVf or kEe.
[[nodiscard]] PlanePassage plane_passage(const PairMotion<double>& motion);

/// A contact found in a list of pairs.
struct LaneContact {
  std::uint32_t pair;  ///< its place in the list
  PlanePassage passage;
  int exponent;  ///< as PairMotion's, of the positions themselves
};

/// The same for the `pairs` at the places of `numbers`, with the same bits. Appends the contacts to `contacts`; leaves
/// in `numbers` the pairs that are neither in contact nor PROVED free of touch in [0,1] and farther apart than
/// `tolerance` at t = 1, ascending. REQUIRES what cull_in_lanes requires, and motion.is_exact().
void pass_in_lanes(const LaneMotion& motion, const LanePairs& pairs, double tolerance, PairNumbers& numbers,
                   std::vector<LaneContact>& contacts);

}  // namespace selvage::detail
