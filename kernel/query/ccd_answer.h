// What a query answers once its search has ended: at a contact, or at t = 1.
#pragma once

#include "kernel/arithmetic/time_ticks.h"
#include "kernel/ccd.h"
#include "kernel/query/pair_motion.h"
#include "kernel/query/plane_passage.h"

namespace selvage::detail {

[[nodiscard]] DifferencePolygon<double> polygon_at_tick(const PairMotion<double>& motion, Tick tick);

/// PROVED: the features come within this distance, scaled, at the tick whose polygon is `at`.
[[nodiscard]] double gap_upper(const PairMotion<double>& motion, Tick tick, const DifferencePolygon<double>& at,
                               const std::array<double, 4>& weights);

/// The answer to a contact of plain doubles, in canonical order; `exponent` as PairMotion's.
[[nodiscard, gnu::noinline]] CcdResult contact_answer(const PlanePassage& passage, int exponent);

/// Fills in a contact at the tick from the features' closest points, with the normal they had a little before.
/// Unresolved if the gap is no alarm's.
void answer_contact(CcdResult& result, const PairMotion<double>& motion, Tick tick);

/// Fills in the answer to a motion that is proved free of touch: what remains is the distance at t = 1.
void answer_end(CcdResult& result, const PairMotion<double>& motion, double tolerance);

}  // namespace selvage::detail
