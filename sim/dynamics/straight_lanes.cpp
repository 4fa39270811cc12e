#include "sim/dynamics/straight_lanes.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sim/dynamics/straight_lanes.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "sim/dynamics/pack_columns-inl.h"

HWY_BEFORE_NAMESPACE();
namespace selvage::sim::HWY_NAMESPACE {

/// Of the body's edge, the weight of its nearer end: 1 where it is a vertex that is in the pair.
HWY_INLINE Value NearerEnd(const PackStraight& straight, const PackNearest& nearest, std::size_t first) {
  const auto weight = [&](std::size_t k) { return hn::Abs(Read(nearest.weights[k], first)); };
  const Value of_first = hn::Min(weight(0), weight(1)), of_second = hn::Min(weight(2), weight(3));
  const Value of_edge = hn::IfThenElse(TruthOf(straight.edges[1], first), of_second, Number(1));
  return hn::IfThenElse(TruthOf(straight.edges[0], first), of_first, of_edge);
}

/// Lanes whose nearest points are at the end of the body's edge that is its first, or second, vertex.
HWY_INLINE Truth IsAtEnd(std::size_t end, const PackStraight& straight, const PackNearest& nearest, std::size_t first) {
  const auto is_zero = [&](std::size_t k) { return hn::Eq(Read(nearest.weights[k], first), hn::Zero(Real())); };
  return hn::Or(hn::And(TruthOf(straight.edges[0], first), is_zero(1 - end)),
                hn::And(TruthOf(straight.edges[1], first), is_zero(3 - end)));
}

LaneMask TurnAcross(const PackStraight& straight, double share, PackNearest& nearest) {
  const Value one = Number(1);
  LaneMask beyond = 0;
  for (std::size_t first = 0; first < kLanes; first += VectorLanes()) {
    const auto direction_of = [&](const PackStraight::Part& part) {
      const Vector t0 = Read(part.direction_t0, first), t1 = Read(part.direction_t1, first);
      return Sum(t0, Scaled(Number(share), Difference(t1, t0)));
    };
    Vector straight_way = direction_of(straight.parts[0]);
    Value share_on = NearerEnd(straight, nearest, first);
    std::array<Value, 2> extents{Read(straight.parts[0].extents_m[0], first),
                                 Read(straight.parts[0].extents_m[1], first)};
    Truth is_line = TruthOf(straight.parts[0].lines, first), is_plane = TruthOf(straight.parts[0].planes, first);
    for (const std::size_t end : {0U, 1U}) {
      const PackStraight::Part& part = straight.parts[end + 1];
      const Truth is_there = IsAtEnd(end, straight, nearest, first);
      straight_way = lanes::Choose<Real>(is_there, direction_of(part), straight_way);
      share_on = hn::IfThenElse(is_there, one, share_on);
      for (const std::size_t side : {0U, 1U}) {
        extents[side] = hn::IfThenElse(is_there, Read(part.extents_m[side], first), extents[side]);
      }
      is_line = hn::Or(hn::And(is_there, TruthOf(part.lines, first)), hn::AndNot(is_there, is_line));
      is_plane = hn::Or(hn::And(is_there, TruthOf(part.planes, first)), hn::AndNot(is_there, is_plane));
    }
    const Vector unit = Scaled(hn::Div(one, hn::Sqrt(DotOf(straight_way, straight_way))), straight_way);
    const Vector direction = Read(nearest.direction, first);
    const Value along_unit = DotOf(direction, unit);
    const Vector part = Scaled(along_unit, unit), rest = Difference(direction, part);
    const Vector along = lanes::Choose<Real>(is_line, part, rest), left = lanes::Choose<Real>(is_line, rest, part);
    const Truth is_straight = hn::Or(is_line, is_plane);
    const Value size = hn::Sqrt(DotOf(left, left)), distance = Read(nearest.distance, first);
    const Value extent = hn::IfThenElse(hn::Gt(along_unit, hn::Zero(Real())), extents[1], extents[0]);
    const Value farthest = hn::Add(hn::Mul(share_on, extent), hn::Mul(Number(kStraight), distance));
    const Truth is_far = hn::Gt(hn::Mul(distance, hn::Sqrt(DotOf(along, along))), farthest);
    const Truth is_left = hn::Gt(size, Number(kLeastAcross));
    beyond |= LanesOf(hn::And(is_straight, hn::Or(is_far, hn::Not(is_left))), first);
    const Truth turns = hn::And(is_straight, is_left);
    WriteWhere(turns, Scaled(hn::Div(one, size), left), first, nearest.direction);
    WriteWhere(turns, hn::Mul(size, distance), first, nearest.distance);
  }
  return beyond;
}

}  // namespace selvage::sim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace selvage::sim {

void set_straight(PairKind kind, const StraightFeature& feature, const Positions& V_t0, const Positions& V_t1,
                  std::size_t lane, PackStraight& pack) {
  if (kind == PairKind::kEe) pack.edges[feature.first == 0 ? 0 : 1] |= only_lane(lane);
  for (std::size_t i = 0; i < feature.parts.size(); ++i) {
    const StraightSurface& surface = feature.parts[i];
    PackStraight::Part& part = pack.parts[i];
    if (surface.kind == StraightSurface::Kind::kLine) part.lines |= only_lane(lane);
    if (surface.kind == StraightSurface::Kind::kPlane) part.planes |= only_lane(lane);
    for (const std::size_t side : {0U, 1U}) part.extents_m[side][lane] = surface.extents_m[side];
    const Vec3 t0 = surface.direction(V_t0), t1 = surface.direction(V_t1);
    for (std::size_t k = 0; k < 3; ++k) {
      part.direction_t0[k][lane] = t0[static_cast<Eigen::Index>(k)];
      part.direction_t1[k][lane] = t1[static_cast<Eigen::Index>(k)];
    }
  }
}

HWY_EXPORT(TurnAcross);
LaneMask turn_across(const PackStraight& straight, double share, PackNearest& nearest) {
  return HWY_DYNAMIC_DISPATCH(TurnAcross)(straight, share, nearest);
}

}  // namespace selvage::sim
#endif
