#include <algorithm>
#include <cmath>

#include "fuzz/draw/query_makers.h"

namespace selvage::fuzz::make {
namespace {

struct Plane {
  LatticePoint u, v, normal;
  std::int64_t length;  // of the normal: an integer, so distances along it are exact
};

Plane choose_plane(ChoiceSource& source) {
  const std::array<Plane, 4> planes{{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, 1},
                                     {{0, 1, 0}, {0, 0, 1}, {1, 0, 0}, 1},
                                     {{4, 0, -3}, {0, 1, 0}, {3, 0, 4}, 5},
                                     {{2, -1, 0}, {0, 1, -1}, {1, 2, 2}, 3}}};
  return planes[source.n(planes.size())];
}

/// Both features stay parallel to the plane, and their contact points meet above each other: the distance then is the
/// one of two parallel planes.
AnyContact choose_parallel(ChoiceSource& source, PairKind kind, const Plane& plane) {
  AnyContact contact = choose_contact(source, kind, 3);
  for (auto* placement : {&contact.x, &contact.v}) {
    for (auto& vector : placement->span) vector = choose_in_plane(source, {plane.u, plane.v}, 2);
  }
  return contact;
}

/// About 1, from either side: the distance over the gap.
double choose_share(ChoiceSource& source) {
  switch (source.n(4)) {
    case 1:
      return 1 - source.unit_real() / 2;
    case 2:
      return 1 + source.unit_real();
    case 3:
      return std::ldexp(1, source.range(1, 8));
    default:
      return 1;
  }
}

/// The unit of a query that comes about as near as a gap, and the length of its sides in it. Heights have 2^18 units or
/// more, so that those beside the gap differ little from it.
struct Grain {
  int exponent, side_bits;
};

Grain choose_grain(ChoiceSource& source, const DeclaredGap& gap) {
  constexpr int kHeightBits = 19, kSideBits = 38, kLowest = -1000, kHighest = 900;  // in the domain, and not subnormal
  const bool has_length = gap.tolerance > 0 && std::ilogb(gap.tolerance) >= kLowest + kHeightBits;
  if (has_length && (gap.relative_tolerance == 0 || source.coin())) {
    return {std::min(std::ilogb(gap.tolerance) - kHeightBits, kHighest), source.range(0, kSideBits)};
  }
  // As large as makes the part of the size the larger one.
  const double size = has_length ? gap.tolerance / gap.relative_tolerance : 1;
  const int least = std::isfinite(size) ? std::clamp(std::ilogb(size) - kSideBits, kLowest, kHighest) : kHighest;
  return {std::min(least + source.range(0, 60), kHighest), kSideBits};
}

}  // namespace

MotionQuery end_at_tolerance(ChoiceSource& source, PairKind kind) {
  const Plane plane = choose_plane(source);
  AnyContact contact = choose_parallel(source, kind, plane);
  contact.time = {1, 1};
  const std::int64_t height = 1 + source.n(1U << 20);
  contact.x.gap = height * plane.normal;
  contact.v.gap = -static_cast<std::int64_t>(source.n(8)) * plane.normal;  // from farther away, or no approach
  LatticeMotion motion = motion_of(kind, contact);
  if (source.coin()) translate(motion, choose_point(source, 1U << 20));
  const int exponent = -source.range(0, 60);
  MotionQuery query = to_query(kind, motion, exponent);
  const double distance = std::ldexp(static_cast<double>(height * plane.length), exponent);
  query.options.tolerance = source.coin() ? std::nextafter(distance, 0.0) : distance;
  return query;
}

MotionQuery beside_gap(ChoiceSource& source, PairKind kind, const DeclaredGap& gap) {
  const Plane plane = choose_plane(source);
  AnyContact contact = choose_parallel(source, kind, plane);
  const Grain grain = choose_grain(source, gap);
  const int exponent = grain.exponent;
  const std::int64_t side = std::int64_t{1} << grain.side_bits;
  for (auto& vector : contact.x.span) vector *= side;
  if (source.coin()) {  // comes to it, or leaves it, along the normal
    contact.time = {1, 1};
    const std::int64_t speed = std::int64_t{1} << source.range(0, 23);
    contact.v.gap = -speed * plane.normal;
  } else {  // slides past
    contact.v.gap = choose_in_plane(source, {plane.u, plane.v}, 2);
  }
  const double share = choose_share(source);
  const std::int64_t beside = source.zigzag(2);
  const LatticePoint offset = source.coin() ? choose_point(source, 1U << 20) : LatticePoint(LatticePoint::Zero());
  const bool is_reversed = source.coin();
  const auto at_height = [&](std::int64_t height) {
    contact.x.gap = height * plane.normal;
    LatticeMotion motion = motion_of(kind, contact);
    translate(motion, offset);
    return to_query(kind, motion, exponent);
  };
  MotionQuery query = at_height(1);
  for (int again = 0; again < 3; ++again) {  // the height is a part of the size that the gap may depend on
    const double units = std::ldexp(share * gap.of(query), -exponent) / static_cast<double>(plane.length);
    query = at_height(std::max(std::int64_t{1}, static_cast<std::int64_t>(std::min(units, 0x1p45)) + beside));
  }
  if (is_reversed) std::swap(query.x_t0, query.x_t1);
  return query;
}

}  // namespace selvage::fuzz::make
