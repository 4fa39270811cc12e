// Constructed contacts are checked here by their definition, in integers, without the exact checker.
#include "fuzz/draw/contact.h"

#include <gtest/gtest.h>

#include "tests/property.h"

namespace selvage::fuzz {
namespace {

/// denominator * x(t) for t = time.
LatticePoints at(const LatticeMotion& motion, const RationalTime& time) {
  LatticePoints x;
  for (std::size_t i = 0; i < 4; ++i) {
    x[i] = (time.denominator - time.numerator) * motion.x_t0[i] + time.numerator * motion.x_t1[i];
  }
  return x;
}

/// side[0] * side[1] * (contact point on the first feature - the one on the second).
LatticePoint gap(PairKind kind, const ContactWeights& weights, const LatticePoints& x) {
  const auto& [side, at] = weights;
  switch (kind) {
    case PairKind::kVf:
      return side[1] * (side[0] * (x[0] - x[1]) - at[0] * (x[2] - x[1]) - at[1] * (x[3] - x[1]));
    case PairKind::kEe:
      return side[0] * side[1] * (x[0] - x[2]) + side[1] * at[0] * (x[1] - x[0]) - side[0] * at[1] * (x[3] - x[2]);
    case PairKind::kSelf:
      break;
  }
  return side[1] * (side[0] * (x[0] - x[1]) - at[0] * (x[2] - x[1]));
}

TEST(Contact, ConstructedContactsTouchWhereAndWhenTheySay) {
  for (const PairKind kind : kPairKinds) {
    for (std::uint64_t seed = 0; seed < 3000; ++seed) {
      ChoiceSource source = ChoiceSource::from_seed(seed);
      const ContactPlace where = choose_any_place(source);
      const ContactWeights weights = choose_weights(source, kind, where);
      const RationalTime time = choose_time(source, choose_any_time(source));
      Placement x = choose_placement(source, 1000);
      x.gap.setZero();
      LatticeMotion motion =
          motion_through(place(kind, weights, x), place(kind, weights, choose_placement(source, 1000)), time);
      translate(motion, choose_point(source, 1000));
      ASSERT_EQ(gap(kind, weights, at(motion, time)), LatticePoint::Zero().eval()) << name_of(kind) << " " << seed;
    }
  }
}

TEST(Contact, GapIsTheVectorBetweenTheContactPoints) {
  for (const PairKind kind : kPairKinds) {
    for (std::uint64_t seed = 0; seed < 1000; ++seed) {
      ChoiceSource source = ChoiceSource::from_seed(seed);
      const ContactWeights weights = choose_weights(source, kind, choose_any_place(source));
      const Placement x = choose_placement(source, 1000);
      const LatticePoint expected = weights.side[0] * weights.side[1] * x.gap;
      ASSERT_EQ(gap(kind, weights, place(kind, weights, x)), expected) << name_of(kind) << " " << seed;
    }
  }
}

TEST(Contact, PlacesAreWhatTheySay) {
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    for (const ContactPlace where : {ContactPlace::kInterior, ContactPlace::kEdge, ContactPlace::kVertex}) {
      ChoiceSource source = ChoiceSource::from_seed(seed);
      const auto [side, at] = choose_weights(source, PairKind::kVf, where);
      const int zero_weights = (at[0] == 0) + (at[1] == 0) + (side[0] == at[0] + at[1]);
      ASSERT_EQ(zero_weights, static_cast<int>(where));
      const auto [edges, along] = choose_weights(source, PairKind::kEe, where);
      int ends = 0;
      for (std::size_t edge = 0; edge < 2; ++edge) ends += along[edge] == 0 || along[edge] == edges[edge];
      ASSERT_EQ(ends, static_cast<int>(where));
    }
  }
}

TEST(Contact, TimesAreWhatTheySay) {
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    ChoiceSource source = ChoiceSource::from_seed(seed);
    const RationalTime start = choose_time(source, ContactTime::kStart);
    const RationalTime middle = choose_time(source, ContactTime::kMiddle);
    const RationalTime end = choose_time(source, ContactTime::kEnd);
    ASSERT_EQ(start.numerator, 0);
    ASSERT_EQ(end.numerator, end.denominator);
    ASSERT_TRUE(0 < middle.numerator && middle.numerator < middle.denominator);
  }
}

}  // namespace
}  // namespace selvage::fuzz
