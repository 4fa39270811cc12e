// An interval looked at with double-double arithmetic, in parts of 2^-100.
#include "kernel/ccd_search.h"
#include "kernel/closest_point.h"
#include "kernel/separation.h"

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

Polygon polygon_within(const PairMotion<DoubleDouble>& motion, Part time) {
  const auto tick = static_cast<Tick>(time >> kPartBits);
  const auto part = static_cast<Tick>(time) & ((Tick{1} << kPartBits) - 1);
  const double offset = static_cast<double>(part) * 0x1p-100;
  return polygon_at(motion, two_sum(time_of(kTicks - tick), -offset), two_sum(time_of(tick), offset));
}

bool is_near(const ClosestPoint<DoubleDouble>& closest) {
  return leading(dot(closest.point, closest.point)) < kNoPreciseGap * kNoPreciseGap;
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
    const Part end = ends[depth - 1], middle = begin + (end - begin) / 2;
    const Polygon at_end = polygon_within(motion, end);
    const auto closest = closest_point(motion.kind, polygon_within(motion, middle));
    if (separates(motion, at_begin, at_end, closest.direction) ||
        separates(motion, at_begin, at_end, closest.plane_normal) || winds_apart(motion, at_begin, at_end) ||
        separating_direction(motion, at_begin, at_end, closest.point)) {
      begin = end;
      at_begin = at_end;
      --depth;
    } else if (middle == begin || is_near(closest_point(motion.kind, at_begin)) ||
               (end - begin <= kNarrow && is_near(closest_point(motion.kind, at_end)))) {
      return static_cast<Tick>(begin >> kPartBits);
    } else {
      ends[depth++] = middle;
    }
  }
  return std::nullopt;
}

}  // namespace selvage::detail
