// An interval of a query looked at with double-double arithmetic, in parts of 2^-100.
#pragma once

#include <optional>

#include "kernel/arithmetic/time_ticks.h"
#include "kernel/query/pair_motion.h"

namespace selvage::detail {

/// An interval of this many ticks around a simple root is not divided further: toi_lower is early by no more.
inline constexpr Tick kNarrowWidth = 3;

/// Where double-double arithmetic cannot prove the features of `motion` apart within the interval: the tick at or
/// before the first such instant; nothing where the whole interval is PROVED free of touch. `suspect` is a time worth
/// looking at first, as a fraction of the interval. `left` is how many more intervals may be looked at, and is lowered
/// by those that were (K8); when it runs out, or after kMaxPreciseIntervals, the rest counts as not proved.
[[nodiscard]] std::optional<Tick> first_precise_contact(const PairMotion<DoubleDouble>& motion,
                                                        const TickInterval& interval, double suspect,
                                                        std::int32_t& left);
/// At some 5 us each. On the fuzzer's classes 48 leave one of 48,000 contacts without an alarm's gap, as 128 do, for
/// two thirds of the time; 32 leave six.
inline constexpr int kMaxPreciseIntervals = 48;

}  // namespace selvage::detail
