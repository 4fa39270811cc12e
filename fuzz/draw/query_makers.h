// The makers behind the classes of generators.cpp, grouped by what makes a query hard.
#pragma once

#include "fuzz/draw/contact.h"

namespace selvage::fuzz::make {

/// Integers this small tie often; integers this large fill half of a double.
enum class Grid : std::uint8_t { kLattice, kUniform };

// contact_makers.cpp: constructed contacts and near misses
/// An exact touch, then an exact offset by up to 2^48 in half of the cases.
MotionQuery contact(ChoiceSource& source, PairKind kind, ContactTime time, ContactPlace place, Grid grid);
/// The touch is missed by a few lattice units, at an offset up to 2^48 units.
MotionQuery near_miss(ChoiceSource& source, PairKind kind);
/// A constructed touch that rounding after an inexact offset may destroy.
MotionQuery rounded_contact(ChoiceSource& source, PairKind kind);
/// The relative motion at the touch is tangent to both features: the coplanarity cubic has a double root there.
MotionQuery double_root(ChoiceSource& source, PairKind kind);
/// ... and its second derivative vanishes too.
MotionQuery triple_root(ChoiceSource& source, PairKind kind);
/// A touch in a motion 2^40 times shorter, or longer, than the features.
MotionQuery short_motion(ChoiceSource& source, PairKind kind);
MotionQuery huge_motion(ChoiceSource& source, PairKind kind);
/// Sides 1 : 2^30 apart.
MotionQuery needle(ChoiceSource& source, PairKind kind);
/// Nearly parallel sides: a triangle that is almost a segment, edges that are almost parallel, or exactly so. One in
/// eight is near-coplanar instead.
MotionQuery sliver(ChoiceSource& source, PairKind kind);

// parallel_makers.cpp: distances that are known, of features in two parallel planes
/// Never touches, and ends at a distance that is the tolerance exactly, or one ulp above it.
MotionQuery end_at_tolerance(ChoiceSource& source, PairKind kind);
/// Never touches. Comes about as near as the gap: from half of it to twice it, or by a power of two farther, up to
/// 2^8; at the end, at the start, or in between as it slides past. REQUIRES vf or ee, both tolerances finite.
MotionQuery beside_gap(ChoiceSource& source, PairKind kind, const DeclaredGap& gap);

// lattice_makers.cpp: ties and degeneracies by chance, on small integers
/// Moves one to three coordinates by up to so many ulps.
void nudge(ChoiceSource& source, MotionQuery& query, std::uint32_t ulps);
/// Integers up to 1, 2 or 3, or a contact on them, with one to three coordinates moved by up to three ulps; one in
/// eight is a near miss or a rounded contact.
MotionQuery lattice_ulp(ChoiceSource& source, PairKind kind);
/// Duplicate vertices, collinear corners, zero-length edges.
MotionQuery degenerate(ChoiceSource& source, PairKind kind);
/// All points stay in one moving plane: the cubic is identically zero.
MotionQuery in_plane(ChoiceSource& source, PairKind kind);
/// All points within a little of one plane.
MotionQuery near_coplanar(ChoiceSource& source, PairKind kind);
MotionQuery same_velocity(ChoiceSource& source, PairKind kind);
MotionQuery no_motion(ChoiceSource& source, PairKind kind);
/// Both features turn by one rational rotation, so straight paths dip inside the arc.
MotionQuery rigid_rotation(ChoiceSource& source, PairKind kind);

// meeting_makers.cpp: corners that come together in mid-step, three in four with one to three coordinates moved by up
// to three ulps
/// All corners meet in one point at a rational time: every difference of two vanishes at once. One in four meets in two
/// points, each corner in one of them.
MotionQuery one_point(ChoiceSource& source, PairKind kind);
/// The end positions are the start positions in another order: corners that change places pass each other half-way.
MotionQuery exchange(ChoiceSource& source, PairKind kind);

// resting_makers.cpp
/// A contact, one in four missed by a unit, of which one feature rests, or all corners but one. What moves does so
/// along an axis in half of the cases, along the normal of both features in a quarter; in half of them both features
/// are level in that axis at the touch.
MotionQuery resting(ChoiceSource& source, PairKind kind);

// scale_makers.cpp: the exponent range
MotionQuery scaled(ChoiceSource& source, PairKind kind, int exponent_first, int exponent_last);
/// In units of 2^-1040 to 2^-341, half of them where cubes or squares of coordinates begin to underflow.
MotionQuery tiny(ChoiceSource& source, PairKind kind);
/// Axes with units of their own, or one of 2^-340 to 2^340 for all: contacts stay contacts.
MotionQuery mixed_axes(ChoiceSource& source, PairKind kind);
/// Every coordinate with an exponent of its own.
MotionQuery mixed_coordinates(ChoiceSource& source, PairKind kind, int exponent_radius);
MotionQuery uniform(ChoiceSource& source, PairKind kind);

// recorded_makers.cpp
/// A candidate pair of a step of a simulation, as it was or continued up to 2^6 times as far, with a few ulps changed
/// in half of the cases. REQUIRES vf or ee.
MotionQuery recorded(ChoiceSource& source, PairKind kind);

}  // namespace selvage::fuzz::make
