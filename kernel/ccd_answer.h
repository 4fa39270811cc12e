// What a query answers once its search has ended: at a contact, or at t = 1.
#pragma once

#include "kernel/ccd.h"
#include "kernel/pair_motion.h"
#include "kernel/time_ticks.h"

namespace selvage::detail {

[[nodiscard]] DifferencePolygon<double> polygon_at_tick(const PairMotion<double>& motion, Tick tick);

/// PROVED: the features come within this distance, scaled, at the tick whose polygon is `at`.
[[nodiscard]] double gap_upper(const PairMotion<double>& motion, Tick tick, const DifferencePolygon<double>& at,
                               const std::array<double, 4>& weights);

/// An alarm is raised only with a witness this near, relative to the largest difference (in [0.5, 1) after scaling).
/// One tick is left uncertified only if the gap in it is of the order of the rounding of one support, 3 kSupportError,
/// plus the motion within one tick, 2^-51: below 2^-48. The rest is room for directions that are not optimal.
inline constexpr double kAlarmGap = 0x1p-40;

/// Fills in a contact at the tick: `direction` becomes the normal. Unresolved if the gap is no alarm's.
void answer_contact(CcdResult& result, const PairMotion<double>& motion, Tick tick, double gap,
                    const std::array<double, 4>& weights, const Double3& direction);
/// The same from the features' closest points, with the normal they had a little before.
void answer_contact(CcdResult& result, const PairMotion<double>& motion, Tick tick);

/// Fills in the answer to a motion that is proved free of touch: what remains is the distance at t = 1.
void answer_end(CcdResult& result, const PairMotion<double>& motion, double tolerance);

}  // namespace selvage::detail
