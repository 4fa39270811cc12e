#include <cmath>

#include "fuzz/draw/query_makers.h"

namespace selvage::fuzz::make {
namespace {

/// A contact or a near miss of any kind, in integers below 2^13.
LatticeMotion small_contact(ChoiceSource& source, PairKind kind) {
  const ContactWeights weights = choose_weights(source, kind, choose_any_place(source));
  Placement x = choose_placement(source, 3);
  if (!source.one_in(3)) x.gap.setZero();
  const Placement v = choose_placement(source, 3);
  const RationalTime time = choose_time(source, choose_any_time(source));
  return motion_through(place(kind, weights, x), place(kind, weights, v), time);
}

}  // namespace

MotionQuery scaled(ChoiceSource& source, PairKind kind, int exponent_first, int exponent_last) {
  const LatticeMotion motion = small_contact(source, kind);
  return to_query(kind, motion, source.range(exponent_first, exponent_last));
}

MotionQuery tiny(ChoiceSource& source, PairKind kind) {
  const LatticeMotion motion = small_contact(source, kind);
  switch (source.n(4)) {
    case 1:
      return to_query(kind, motion, source.range(-380, -340));
    case 2:
      return to_query(kind, motion, source.range(-550, -490));
    default:
      return to_query(kind, motion, source.range(-1040, -341));
  }
}

MotionQuery mixed_axes(ChoiceSource& source, PairKind kind) {
  const LatticeMotion motion = small_contact(source, kind);
  if (source.one_in(4)) return to_query(kind, motion, source.range(-340, 340));
  std::array<int, 3> exponents{};
  for (int& exponent : exponents) exponent = static_cast<int>(source.zigzag(60));
  return to_query(kind, motion, exponents);
}

MotionQuery mixed_coordinates(ChoiceSource& source, PairKind kind, int exponent_radius) {
  MotionQuery query;
  query.kind = kind;
  for (auto* x : {&query.x_t0, &query.x_t1}) {
    for (auto& point : *x) {
      for (auto& coordinate : point) {
        const auto exponent = static_cast<int>(source.zigzag(static_cast<std::uint32_t>(exponent_radius)));
        coordinate = std::ldexp(source.coin() ? source.signed_real() : static_cast<double>(source.zigzag(3)), exponent);
      }
    }
  }
  return query;
}

MotionQuery uniform(ChoiceSource& source, PairKind kind) {
  MotionQuery query;
  query.kind = kind;
  for (auto* x : {&query.x_t0, &query.x_t1}) {
    for (auto& point : *x) {
      for (auto& coordinate : point) coordinate = source.signed_real();
    }
  }
  return query;
}

}  // namespace selvage::fuzz::make
