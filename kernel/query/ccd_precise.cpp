#include "kernel/query/ccd_precise.h"

#include <cmath>

#include "kernel/query/closest_point.h"
#include "kernel/query/separation.h"

namespace selvage::detail {

namespace {

using Polygon = DifferencePolygon<DoubleDouble>;

/// Times in parts of 2^-100: a tick and its part together are exact in a DoubleDouble.
__extension__ using Part = unsigned __int128;
constexpr int kPartBits = 48;  // in a tick
constexpr Part kNarrow = Part{kNarrowWidth} << kPartBits;

/// Distances below this are of the order of double-double rounding, as are those that a guessed time leaves: no
/// direction will separate them.
constexpr double kNoPreciseGap = 0x1p-94;

/// Of an interval, at whose begin the features are about to touch where a direction separates no more of it.
constexpr double kTinyShare = 0x1p-20;

/// Where to split an interval that is not certified, of which a direction separates this share at the begin; 0 if none
/// does. Where the share is tiny, half way to it in powers of two: from a whole step down to a touch this takes a third
/// of the splits that halving does. With 2^-8 a sixth, but then more contacts of slivers end without an alarm's gap: 16
/// of 167,000 in the fuzzer's classes, where halving alone leaves 5 and this 1.
double split_share(double reach_share) { return reach_share < kTinyShare ? std::sqrt(reach_share) : 0.5; }

Polygon polygon_within(const PairMotion<DoubleDouble>& motion, Part time) {
  const auto tick = static_cast<Tick>(time >> kPartBits);
  const auto part = static_cast<Tick>(time) & ((Tick{1} << kPartBits) - 1);
  const double offset = static_cast<double>(part) * 0x1p-100;
  return polygon_at(motion, two_sum(time_of(kTicks - tick), -offset), two_sum(time_of(tick), offset));
}

bool is_near(const ClosestPoint<DoubleDouble>& closest) {
  return leading(dot(closest.point, closest.point)) < kNoPreciseGap * kNoPreciseGap;
}

bool certify(const PairMotion<DoubleDouble>& motion, const Polygon& begin, const Polygon& end,
             const ClosestPoint<DoubleDouble>& middle) {
  return separates(motion, begin, end, middle.direction) || separates(motion, begin, end, middle.plane_normal) ||
         winds_apart(motion, begin, end) || separating_direction(motion, begin, end, middle.point);
}

/// How many pieces still wait after those, the next ones, over which the direction separates from `begin` on. Features
/// that have passed each other move apart: without this the way out costs an interval for each split of the way in.
std::size_t depth_beyond(const PairMotion<DoubleDouble>& motion, const Polygon& begin,
                         const Triple<DoubleDouble>& direction, const std::array<Part, 128>& ends, std::size_t depth) {
  while (depth > 0 && separates(motion, begin, polygon_within(motion, ends[depth - 1]), direction)) --depth;
  return depth;
}

}  // namespace

std::optional<Tick> first_precise_contact(const PairMotion<DoubleDouble>& motion, const TickInterval& interval,
                                          double suspect, std::int32_t& left) {
  Part begin = Part{interval.begin} << kPartBits;
  const Part last = Part{interval.end} << kPartBits;
  const auto suspect_offset = static_cast<Part>(suspect * static_cast<double>(interval.end - interval.begin) * 0x1p+48);
  if (last - begin <= kNarrow && is_near(closest_point(motion.kind, polygon_within(motion, begin + suspect_offset)))) {
    return interval.begin;
  }
  std::array<Part, 128> ends;
  std::size_t depth = 1;
  ends[0] = last;
  Polygon at_begin = polygon_within(motion, begin);
  for (int count = 0; depth > 0; ++count) {
    if (left <= 0 || count == kMaxPreciseIntervals) return static_cast<Tick>(begin >> kPartBits);
    --left;
    const Part end = ends[depth - 1], width = end - begin;
    const Polygon at_end = polygon_within(motion, end);
    const auto nearest = closest_point(motion.kind, at_begin);
    const auto reach = separated_reach(motion, at_begin, at_end, nearest);
    if (reach.share == 0 && is_near(nearest)) return static_cast<Tick>(begin >> kPartBits);
    const auto reached = static_cast<Part>(reach.share * static_cast<double>(width));
    // Where the motion along the direction is all there is, what it separates ends at the touch: edges that lie in one
    // line throughout take 11 intervals there in place of 24 to 31, in a seventh to an eleventh of the time. What
    // follows is then looked at from there on, by itself.
    const bool may_arrive = reach.share < kTinyShare && !is_near(nearest);
    if ((reach.share > kFarShare || may_arrive) && reach.share < 1 && reached > 0) {
      const Polygon at_reached = polygon_within(motion, begin + reached);
      const bool goes_on = !may_arrive || is_near(closest_point(motion.kind, at_reached));
      if (goes_on && separates(motion, at_begin, at_reached, reach.direction)) {
        begin += reached;
        at_begin = at_reached;
        if (may_arrive && end - begin > kNarrow) ends[depth++] = begin + kNarrow;
        continue;
      }
    }
    const Part middle = begin + width / 2;
    if (separates(motion, at_begin, at_end, reach.direction)) {
      depth = depth_beyond(motion, at_begin, reach.direction, ends, depth - 1);
      begin = ends[depth];
      at_begin = polygon_within(motion, begin);
    } else if (certify(motion, at_begin, at_end, closest_point(motion.kind, polygon_within(motion, middle)))) {
      begin = end;
      at_begin = at_end;
      --depth;
    } else if (middle == begin ||
               (width <= kNarrow && (is_near(nearest) || is_near(closest_point(motion.kind, at_end))))) {
      return static_cast<Tick>(begin >> kPartBits);
    } else {
      const auto split = static_cast<Part>(split_share(reach.share) * static_cast<double>(width));
      ends[depth++] = split > 0 ? begin + split : middle;  // no share, or less than a part of it
    }
  }
  return std::nullopt;
}

}  // namespace selvage::detail
