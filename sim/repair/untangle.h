// Moves cloth that starts intersecting until nothing intersects: the repair of a start, not a part of any step.
//   1. Cloth against cloth (draw_back.h): what has come through is drawn back to the side that most of it is on.
//   2. Cloth against bodies (body_return.h): the bodies shrink, or step aside, until they are free of the cloth, and
//      come back in certified steps that push the cloth out of their way.
//   3. Certified steps take what was moved as near to where it was as it can go.
// What intersects is said by an exact judge that the caller brings, so this needs no exact arithmetic of its own.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "sim/collision_step.h"

namespace selvage::sim {

/// f <= g; twice the same for a face without area.
using FacePair = std::array<FaceId, 2>;

/// The faces that intersect at the given positions, exactly, sorted and each pair once; pairs of two faces of bodies,
/// and faces of bodies without area, are left out. REQUIRES all of them, and no others than faces of the mesh: whether
/// a try has fewer decides what is kept.
using FindIntersections = std::function<std::vector<FacePair>(const Positions& V)>;

struct UntangleOptions {
  double gap_m = 1e-3;        ///< that is tried to be left between what was apart, > 0: the thickness of the cloth
  double tolerance_m = 1e-6;  ///< as CollisionOptions
  CollisionOptions::Precision precision = CollisionOptions::Precision::kFloat64;
  /// Of parts that have a thickness and tolerance of their own, as for CollisionStep; gap_m is the largest of them
  /// then.
  ContactSurfaces surfaces = {};
};

/// Options of the certified steps that untangle() takes; nothing rubs.
[[nodiscard]] CollisionOptions step_options(const UntangleOptions& options);

struct UntangleReport {
  /// Of the pairs at V those that intersected after the best try as well; all, where none of them did but others.
  std::vector<FacePair> remaining;
  std::int32_t rounds = 0;  ///< states that were judged
};

struct UntangleResult {
  Positions x;  ///< free of intersections where report.remaining is empty, else V
  UntangleReport report;
};

/// Scripted vertices (inverse mass 0) are where they were, whatever the policy of the bodies. REQUIRES what
/// CollisionStep does: finite positions in the domain, on the lattice of the precision, one a vertex; bodies, options
/// and surfaces that fit the mesh; and a gap > 0. POST: no pairs remain as `find` judges, or x is V and the pairs say
/// which: pinned across a body, a crossing that no way out was found for. What is clean already is returned as it is.
/// Ends after at most kMaxUntangleRounds + 4 judgements. Deterministic, if `find` is.
[[nodiscard]] UntangleResult untangle(const Mesh& mesh, const PositionsRef& V, const CollisionBodies& bodies,
                                      const UntangleOptions& options, const FindIntersections& find);

/// Each takes a frame check, 4 ms for ten thousand faces.
inline constexpr std::int32_t kMaxUntangleRounds = 2000;

}  // namespace selvage::sim
