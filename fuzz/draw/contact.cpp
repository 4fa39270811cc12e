#include "fuzz/draw/contact.h"

#include <cmath>
#include <cstdlib>

#include "kernel/assert.h"

namespace selvage::fuzz {

LatticePoint choose_point(ChoiceSource& source, std::uint32_t radius) {
  LatticePoint point;
  for (auto& coordinate : point) coordinate = source.zigzag(radius);
  return point;
}

LatticePoint choose_in_plane(ChoiceSource& source, const std::array<LatticePoint, 2>& span, std::uint32_t radius) {
  const std::int64_t first = source.zigzag(radius);
  const std::int64_t second = source.zigzag(radius);
  return first * span[0] + second * span[1];
}

Placement choose_placement(ChoiceSource& source, std::uint32_t radius) {
  Placement placement;
  placement.origin = choose_point(source, radius);
  for (auto& vector : placement.span) vector = choose_point(source, radius);
  placement.gap = choose_point(source, radius);
  return placement;
}

RationalTime choose_time(ChoiceSource& source, ContactTime time) {
  switch (time) {
    case ContactTime::kStart:
      return {0, 1};
    case ContactTime::kEnd:
      return {1, 1};
    case ContactTime::kMiddle:
      break;
  }
  // Powers of two make first touches that a double can hold; the others fall between two doubles.
  constexpr std::array<int, 8> kDenominators{2, 4, 8, 16, 32, 3, 5, 7};
  const int denominator = kDenominators[source.n(kDenominators.size())];
  return {source.range(1, denominator - 1), denominator};
}

ContactTime choose_any_time(ChoiceSource& source) { return static_cast<ContactTime>(source.n(3)); }

ContactPlace choose_any_place(ChoiceSource& source) { return static_cast<ContactPlace>(source.n(3)); }

ContactWeights choose_weights(ChoiceSource& source, PairKind kind, ContactPlace place) {
  if (kind == PairKind::kVf) {
    // Barycentric weights of a, b, c over their sum: none, one or two of them zero.
    std::array<std::int64_t, 3> w{source.range(1, 4), source.range(1, 4), source.range(1, 4)};
    const std::uint32_t corner = source.n(3);
    if (place == ContactPlace::kEdge) w[corner] = 0;
    if (place == ContactPlace::kVertex) w[(corner + 1) % 3] = w[(corner + 2) % 3] = 0;
    const std::int64_t sum = w[0] + w[1] + w[2];
    return {{sum, sum}, {w[1], w[2]}};
  }
  ContactWeights weights;
  for (std::size_t edge = 0; edge < 2; ++edge) {
    const int side = source.range(2, 5);
    weights.side[edge] = side;
    weights.at[edge] = source.range(1, side - 1);
  }
  const bool both = place == ContactPlace::kVertex;
  const std::uint32_t ended = source.n(2);
  for (std::size_t edge = 0; edge < 2; ++edge) {
    if (both || (place == ContactPlace::kEdge && ended == edge))
      weights.at[edge] = source.coin() ? weights.side[edge] : 0;
  }
  return weights;
}

AnyContact choose_contact(ChoiceSource& source, PairKind kind, std::uint32_t radius) {
  AnyContact contact;
  contact.weights = choose_weights(source, kind, choose_any_place(source));
  contact.time = choose_time(source, choose_any_time(source));
  contact.x = choose_placement(source, radius);
  contact.x.gap.setZero();
  contact.v = choose_placement(source, radius);
  return contact;
}

LatticePoints place(PairKind kind, const ContactWeights& weights, const Placement& placement) {
  const auto& [origin, span, gap] = placement;
  const LatticePoint along_first = origin + weights.side[0] * span[0];
  const LatticePoint contact = origin + weights.at[0] * span[0];
  switch (kind) {
    case PairKind::kVf:
      return {contact + weights.at[1] * span[1] + gap, origin, along_first, origin + weights.side[1] * span[1]};
    case PairKind::kEe: {
      const LatticePoint c = contact - weights.at[1] * span[1] - gap;
      return {origin, along_first, c, c + weights.side[1] * span[1]};
    }
    case PairKind::kSelf:
      break;
  }
  return {contact + gap, origin, along_first, contact + gap};
}

LatticeMotion motion_through(const LatticePoints& x, const LatticePoints& v, const RationalTime& time) {
  LatticeMotion motion;
  for (std::size_t i = 0; i < 4; ++i) {
    motion.x_t0[i] = x[i] - time.numerator * v[i];
    motion.x_t1[i] = x[i] + (time.denominator - time.numerator) * v[i];
  }
  return motion;
}

LatticeMotion motion_of(PairKind kind, const AnyContact& contact) {
  return motion_through(place(kind, contact.weights, contact.x), place(kind, contact.weights, contact.v), contact.time);
}

void translate(LatticeMotion& motion, const LatticePoint& offset) {
  for (auto* x : {&motion.x_t0, &motion.x_t1}) {
    for (auto& point : *x) point += offset;
  }
}

MotionQuery to_query(PairKind kind, const LatticeMotion& motion, int exponent) {
  return to_query(kind, motion, {exponent, exponent, exponent});
}

MotionQuery to_query(PairKind kind, const LatticeMotion& motion, const std::array<int, 3>& exponents) {
  constexpr std::int64_t kExact = std::int64_t{1} << 53;
  const auto convert = [&](const LatticePoint& from, Vec3& to) {
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      SELVAGE_ASSERT(std::abs(from[axis]) <= kExact);
      to[axis] = std::ldexp(static_cast<double>(from[axis]), exponents[static_cast<std::size_t>(axis)]);
    }
  };
  MotionQuery query;
  query.kind = kind;
  for (std::size_t i = 0; i < 4; ++i) {
    convert(motion.x_t0[i], query.x_t0[i]);
    convert(motion.x_t1[i], query.x_t1[i]);
  }
  return query;
}

}  // namespace selvage::fuzz
