// The search in time behind vf_ccd, ee_ccd and self_ccd, for the queries that the cull leaves.
#pragma once

#include <optional>

#include "kernel/ccd.h"
#include "kernel/pair_motion.h"
#include "kernel/time_ticks.h"

namespace selvage::detail {

/// The query in canonical order. REQUIRES coordinates and tolerance within the domain. A separated answer carries no
/// weights and no normal.
[[nodiscard]] CcdResult search_in_time(PairKind kind, const PairPoints& x_t0, const PairPoints& x_t1,
                                       const CcdOptions& options);

/// An interval of this many ticks around a simple root is not divided further: toi_lower is early by no more.
inline constexpr Tick kNarrowWidth = 3;

/// Where double-double arithmetic cannot prove the features of `motion` apart within the interval: the tick at or
/// before the first such instant; nothing where the whole interval is PROVED free of touch. `suspect` is a time worth
/// looking at first, as a fraction of the interval. `left` is how many more intervals may be looked at, and is lowered
/// by those that were (K8); when it runs out, or after kMaxPreciseIntervals, the rest counts as not proved.
[[nodiscard]] std::optional<Tick> first_precise_contact(const PairMotion<DoubleDouble>& motion,
                                                        const TickInterval& interval, double suspect,
                                                        std::int32_t& left);
/// Halving from one tick to one part takes 48 intervals, and as many again where the other halves need looking at.
inline constexpr int kMaxPreciseIntervals = 128;

}  // namespace selvage::detail
