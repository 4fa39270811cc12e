#include <cmath>

#include "fuzz/draw/query_makers.h"

namespace selvage::fuzz::make {
namespace {

constexpr std::uint32_t kSmall = 3;         // ties are frequent
constexpr std::uint32_t kLarge = 1U << 22;  // side * span and denominator * velocity stay below 2^30
constexpr int kOffsetBits = 48;             // 2^48 + 2^30 < 2^53: the offset is exact

std::uint32_t radius_of(Grid grid) { return grid == Grid::kLattice ? kSmall : kLarge; }

LatticePoint choose_offset(ChoiceSource& source) {
  LatticePoint offset = LatticePoint::Zero();
  if (!source.coin()) return offset;
  for (auto& coordinate : offset) {
    const std::int64_t size = std::int64_t{1} << source.n(kOffsetBits + 1);
    coordinate = source.zigzag(1) * size;
  }
  return offset;
}

Grid choose_grid(ChoiceSource& source) { return source.coin() ? Grid::kUniform : Grid::kLattice; }

}  // namespace

MotionQuery contact(ChoiceSource& source, PairKind kind, ContactTime time, ContactPlace place_of, Grid grid) {
  const ContactWeights weights = choose_weights(source, kind, place_of);
  Placement x = choose_placement(source, radius_of(grid));
  x.gap.setZero();
  Placement v = choose_placement(source, radius_of(grid));
  // Features that only translate touch along a plane that supports the whole sweep: the edge of every cull.
  if (source.one_in(4)) v.span.fill(LatticePoint::Zero());
  LatticeMotion motion = motion_through(place(kind, weights, x), place(kind, weights, v), choose_time(source, time));
  translate(motion, choose_offset(source));
  return to_query(kind, motion);
}

MotionQuery near_miss(ChoiceSource& source, PairKind kind) {
  AnyContact contact = choose_contact(source, kind, radius_of(choose_grid(source)));
  contact.x.gap = choose_point(source, 2);
  LatticeMotion motion = motion_of(kind, contact);
  translate(motion, choose_offset(source));
  return to_query(kind, motion);
}

MotionQuery rounded_contact(ChoiceSource& source, PairKind kind) {
  const AnyContact contact = choose_contact(source, kind, kLarge);
  MotionQuery query = to_query(kind, motion_of(kind, contact), -24);
  // Coordinates below 2^6 in units of 2^-24 hold 30 bits; an offset with a full mantissa, or beyond 2^29, drops some.
  Vec3 offset;
  for (auto& coordinate : offset) {
    const int exponent = source.range(0, 40);
    coordinate = std::ldexp(source.signed_real(), exponent);
  }
  for (auto* x : {&query.x_t0, &query.x_t1}) {
    for (auto& point : *x) point += offset;
  }
  return query;
}

MotionQuery double_root(ChoiceSource& source, PairKind kind) {
  AnyContact contact = choose_contact(source, kind, radius_of(choose_grid(source)));
  contact.v.gap = choose_in_plane(source, contact.x.span, 2);
  if (source.one_in(4)) contact.x.gap = choose_point(source, 1);  // two near roots, or none
  LatticeMotion motion = motion_of(kind, contact);
  translate(motion, choose_offset(source));
  return to_query(kind, motion);
}

// With T = t - t*, e0, e1 the sides at the touch, w0, w1 their velocities, and the relative velocity
// r = alpha e0 + beta e1,
//   f = T (n0 + T (w0 x e1 + e0 x w1) + T^2 w0 x w1) . r,   n0 = e0 x e1,
// the quadratic term is -(alpha w0 + beta w1) . n0 T^2: zero for beta = 0 and w0 in the plane.
MotionQuery triple_root(ChoiceSource& source, PairKind kind) {
  AnyContact contact = choose_contact(source, kind, kSmall);
  contact.v.span[0] = choose_in_plane(source, contact.x.span, 2);
  contact.v.gap = (1 + source.n(3)) * contact.x.span[0];
  if (source.one_in(4)) contact.x.gap = choose_point(source, 1);
  LatticeMotion motion = motion_of(kind, contact);
  translate(motion, choose_offset(source));
  return to_query(kind, motion);
}

MotionQuery short_motion(ChoiceSource& source, PairKind kind) {
  AnyContact contact = choose_contact(source, kind, kSmall);
  constexpr std::int64_t kUnit = std::int64_t{1} << 44;
  contact.x.origin *= kUnit;
  for (auto& vector : contact.x.span) vector *= kUnit;
  if (source.one_in(4)) contact.x.gap = choose_point(source, 2);
  return to_query(kind, motion_of(kind, contact));
}

MotionQuery huge_motion(ChoiceSource& source, PairKind kind) {
  AnyContact contact = choose_contact(source, kind, kSmall);
  const std::int64_t unit = std::int64_t{1} << source.range(10, 40);
  contact.v.origin *= unit;
  contact.v.gap *= unit;
  if (source.coin()) {
    for (auto& vector : contact.v.span) vector *= unit;
  }
  if (source.one_in(4)) contact.x.gap = choose_point(source, 2);
  return to_query(kind, motion_of(kind, contact));
}

MotionQuery needle(ChoiceSource& source, PairKind kind) {
  AnyContact contact = choose_contact(source, kind, kSmall);
  const std::int64_t length = std::int64_t{1} << source.range(10, 30);
  contact.x.span[source.n(2)] *= length;
  if (source.coin()) contact.v.span[source.n(2)] *= length;
  if (source.one_in(4)) contact.x.gap = choose_point(source, 1);
  return to_query(kind, motion_of(kind, contact));
}

MotionQuery sliver(ChoiceSource& source, PairKind kind) {
  if (kind != PairKind::kSelf && source.one_in(8)) return near_coplanar(source, kind);
  AnyContact contact = choose_contact(source, kind, kSmall);
  const std::int64_t length = std::int64_t{1} << source.n(31);
  contact.x.span[0] *= length;
  contact.x.span[1] = (1 + source.n(3)) * contact.x.span[0];
  if (source.coin()) contact.x.span[1] += choose_point(source, 1);
  if (source.one_in(4)) contact.x.gap = choose_point(source, 1);
  return to_query(kind, motion_of(kind, contact));
}

}  // namespace selvage::fuzz::make
