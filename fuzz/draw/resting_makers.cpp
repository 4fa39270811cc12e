#include <Eigen/Geometry>

#include "fuzz/draw/query_makers.h"

namespace selvage::fuzz::make {
namespace {

enum class Way : std::uint8_t { kAxis, kNormal, kFree };

Way choose_way(ChoiceSource& source) {
  constexpr std::array<Way, 4> kWays{Way::kAxis, Way::kAxis, Way::kNormal, Way::kFree};
  return kWays[source.n(kWays.size())];
}

/// The corners of one of the two features, or a single corner of either: [first, end).
struct Corners {
  std::size_t first = 0, end = 0;
};

Corners choose_moving(ChoiceSource& source, PairKind kind) {
  const auto count = static_cast<std::size_t>(point_count(kind));
  const std::size_t first_feature = kind == PairKind::kEe ? 2 : 1;
  switch (source.n(3)) {
    case 0:
      return {0, first_feature};
    case 1:
      return {first_feature, count};
    default:
      break;
  }
  const std::size_t corner = source.n(static_cast<std::uint32_t>(count));
  return {corner, corner + 1};
}

}  // namespace

MotionQuery resting(ChoiceSource& source, PairKind kind) {
  const ContactPlace place_of = choose_any_place(source);
  const ContactWeights weights = choose_weights(source, kind, place_of);
  const ContactTime time_of = choose_any_time(source);
  const RationalTime time = choose_time(source, time_of);
  const std::uint32_t radius = source.coin() ? 1U << 22 : 3;
  Placement x = choose_placement(source, radius);
  x.gap.setZero();
  if (source.one_in(4)) x.gap = choose_point(source, 1);
  const Eigen::Index axis = source.range(0, 2);
  if (source.coin()) x.span[0][axis] = x.span[1][axis] = 0;

  const Way way = choose_way(source);
  // Below 2^46, and below 2^53 with all that it is multiplied by.
  const LatticePoint normal = x.span[0].cross(x.span[1]);
  const auto choose_velocity = [&]() -> LatticePoint {
    if (way == Way::kFree) return choose_point(source, radius);
    if (way == Way::kNormal) return source.zigzag(3) * normal;
    return source.zigzag(radius) * LatticePoint::Unit(axis);
  };
  LatticePoints v;
  v.fill(LatticePoint::Zero());
  const Corners moving = choose_moving(source, kind);
  const bool alike = source.coin();
  for (std::size_t i = moving.first; i < moving.end; ++i) {
    v[i] = alike && i > moving.first ? v[moving.first] : choose_velocity();
  }
  LatticeMotion motion = motion_through(place(kind, weights, x), v, time);
  if (source.coin()) translate(motion, choose_point(source, 1U << 20));
  return to_query(kind, motion);
}

}  // namespace selvage::fuzz::make
