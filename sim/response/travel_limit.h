// Candidates that are no motion but a blow-up are cut back before anything is tested.
#pragma once

#include <cstddef>
#include <cstdint>

#include "sim/response/scripted_groups.h"
#include "sim/response/step_motion.h"

namespace selvage::sim {

/// A cloth vertex travels at most this many diagonals of the scene's box in a step. Pairs whose motion is 10^8 times
/// the distances in the scene cost 60 times as much to decide (measured: 2 us a query up to 10^4, 110 us at 10^8), and
/// all pairs of the scene are candidates then.
inline constexpr double kMaxTravel = 1024;

/// Shortens the displacements of cloth vertices that travel farther, and says how many: 0 in any simulation that has
/// not blown up. The scene's box holds all start positions and the ends of scripts.
[[nodiscard]] std::int64_t limit_travel(const ScriptedGroups& groups, StepMotion& motion);

/// A step in which more pairs than so many a vertex are not free of touch, or as many near only in the end, has no
/// answer in impulses. The curtain finds one for ten vertices in its worst search. All pairs of a mesh at one point
/// take 40 us each: without this limit 3 s for 128 vertices, 55 s for 512, and 3 minutes and 3 GB for 968.
inline constexpr std::size_t kMaxMeetings = 64;
/// So many are borne by the smallest mesh, too, whose whole search costs less than several that are given up: 54
/// vertices with coordinates of all magnitudes took 3.4 s, and 11.4 where 3,456 were too many.
inline constexpr std::size_t kMeetingsOfAnyMesh = std::size_t{1} << 14;
/// But pairs that are near only in the end do not count where more than a 16th of so many are within the tolerance at
/// the start: it is long beside the edges there, and cloth has about as many at the end of any step.
inline constexpr std::size_t kMeetingsPerNearAtStart = 16;
/// How often the motion of cloth is cut back for that, each time by the square of what it was before: to a half, an
/// eighth, 2^-7, 2^-15. So one that meets a little too much keeps half, and one of a million edges, in which pairs of
/// all of the mesh meet until it is about as long as an edge, takes six searches (docs/guarantee-step.md). After the
/// last, nothing is left of any motion within the domain: then all is tested, and what meets is met by bodies.
inline constexpr int kMaxCuts = 12;

/// Halves the displacements of all cloth vertices so many times; how many moved.
[[nodiscard]] std::int64_t halve_travel(const ScriptedGroups& groups, StepMotion& motion, int times);

}  // namespace selvage::sim
