#include "fuzz/draw/query_makers.h"

namespace selvage::fuzz::make {
namespace {

/// Small integers tie; large ones times a denominator of choose_time() stay below 2^28.
std::uint32_t choose_radius(ChoiceSource& source) { return source.coin() ? 1U << 22 : 3; }

}  // namespace

MotionQuery one_point(ChoiceSource& source, PairKind kind) {
  const std::uint32_t radius = choose_radius(source);
  const RationalTime time = choose_time(source, ContactTime::kMiddle);
  const std::array<LatticePoint, 2> meetings{choose_point(source, radius), choose_point(source, radius)};
  const bool two = source.one_in(4);
  LatticePoints x;
  LatticePoints v;
  for (std::size_t i = 0; i < 4; ++i) {
    x[i] = meetings[two ? source.n(2) : 0];
    v[i] = choose_point(source, radius);
  }
  MotionQuery query = to_query(kind, motion_through(x, v, time));
  if (!source.one_in(4)) nudge(source, query, 3);
  return query;
}

MotionQuery exchange(ChoiceSource& source, PairKind kind) {
  const std::uint32_t radius = choose_radius(source);
  LatticeMotion motion;
  for (auto& point : motion.x_t0) point = choose_point(source, radius);
  motion.x_t1 = motion.x_t0;
  for (std::size_t i = static_cast<std::size_t>(point_count(kind)) - 1; i > 0; --i) {
    std::swap(motion.x_t1[i], motion.x_t1[source.n(static_cast<std::uint32_t>(i) + 1)]);
  }
  MotionQuery query = to_query(kind, motion);
  if (!source.one_in(4)) nudge(source, query, 3);
  return query;
}

}  // namespace selvage::fuzz::make
