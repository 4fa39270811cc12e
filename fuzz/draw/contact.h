// Contacts by construction: choose the time, the features and integer weights, then back out the ends of the motion.
// All arithmetic is on integers, so a constructed contact is an exact contact.
#pragma once

#include <array>
#include <cstdint>

#include <Eigen/Core>

#include "fuzz/base/choice_source.h"
#include "fuzz/base/motion_query.h"

namespace selvage::fuzz {

using LatticePoint = Eigen::Matrix<std::int64_t, 3, 1>;
using LatticePoints = std::array<LatticePoint, 4>;

enum class ContactTime : std::uint8_t { kStart, kMiddle, kEnd };
enum class ContactPlace : std::uint8_t { kInterior, kEdge, kVertex };

/// Where on the two features the contact lies. The sides of the features are multiples of `side`, so that the point at
/// `at` is an integer one:
///   vf    p = a + at[0] g0 + at[1] g1,   b = a + side[0] g0,  c = a + side[1] g1   (side[0] == side[1])
///   ee    contact = a + at[0] g0,        b = a + side[0] g0,  c = contact - at[1] g1,  d = c + side[1] g1
///   self  p = a + at[0] g0,              b = a + side[0] g0
struct ContactWeights {
  std::array<std::int64_t, 2> side{1, 1};
  std::array<std::int64_t, 2> at{0, 0};
};

/// A placement of both features, or of their velocities, about a contact: g0, g1 span them, `gap` is the vector from
/// the second feature's contact point to the first one's (zero: they touch).
struct Placement {
  LatticePoint origin = LatticePoint::Zero();
  std::array<LatticePoint, 2> span{LatticePoint::Zero(), LatticePoint::Zero()};
  LatticePoint gap = LatticePoint::Zero();
};

struct LatticeMotion {
  LatticePoints x_t0{}, x_t1{};
};

/// A time numerator/denominator in [0,1].
struct RationalTime {
  std::int64_t numerator = 0, denominator = 1;
};

[[nodiscard]] LatticePoint choose_point(ChoiceSource& source, std::uint32_t radius);
/// A combination of the two vectors with coefficients up to +-radius.
[[nodiscard]] LatticePoint choose_in_plane(ChoiceSource& source, const std::array<LatticePoint, 2>& span,
                                           std::uint32_t radius);
[[nodiscard]] Placement choose_placement(ChoiceSource& source, std::uint32_t radius);
[[nodiscard]] RationalTime choose_time(ChoiceSource& source, ContactTime time);
[[nodiscard]] ContactTime choose_any_time(ChoiceSource& source);
[[nodiscard]] ContactWeights choose_weights(ChoiceSource& source, PairKind kind, ContactPlace place);
[[nodiscard]] ContactPlace choose_any_place(ChoiceSource& source);

/// Any contact, and the velocities about it.
struct AnyContact {
  ContactWeights weights;
  RationalTime time;
  Placement x, v;
};
/// All places and times; spans and velocities up to +-radius.
[[nodiscard]] AnyContact choose_contact(ChoiceSource& source, PairKind kind, std::uint32_t radius);

/// The four points (three for self) of a placement.
[[nodiscard]] LatticePoints place(PairKind kind, const ContactWeights& weights, const Placement& placement);
/// The motion that passes through `x` at `time` with the velocity `v * time.denominator` a step.
[[nodiscard]] LatticeMotion motion_through(const LatticePoints& x, const LatticePoints& v, const RationalTime& time);
[[nodiscard]] LatticeMotion motion_of(PairKind kind, const AnyContact& contact);
void translate(LatticeMotion& motion, const LatticePoint& offset);

/// The same motion in doubles, in units of 2^exponent. Exact: REQUIRES |coordinate| <= 2^53 and no overflow.
[[nodiscard]] MotionQuery to_query(PairKind kind, const LatticeMotion& motion, int exponent = 0);
/// The same with a unit 2^exponent of its own for each axis, which keeps contacts contacts.
[[nodiscard]] MotionQuery to_query(PairKind kind, const LatticeMotion& motion, const std::array<int, 3>& exponents);

}  // namespace selvage::fuzz
