// One pass through section 7 of the paper: repulsions and friction, collisions, impulses, rigid impact zones, and the
// fail-safe behind them.
#pragma once

#include <atomic>
#include <optional>
#include <span>
#include <vector>

#include "kernel/box_hierarchy.h"
#include "sim/base/vertex_faces.h"
#include "sim/collision_step.h"
#include "sim/contact/contact_table.h"
#include "sim/contact/start_proximities.h"
#include "sim/contact/straight_surface.h"
#include "sim/contact/surface_parts.h"
#include "sim/response/collision_tracker.h"
#include "sim/response/impulse.h"
#include "sim/response/repulsion.h"
#include "sim/response/scripted_groups.h"
#include "sim/response/step_limit.h"
#include "sim/response/step_motion.h"

namespace selvage::sim {

/// What persists between steps. Of the room only the memory: pages that are new to a process take time
/// (docs/measurements/simulator-speed.md).
struct StepContext {
  StepContext(const Mesh& step_mesh, const CollisionOptions& step_options, ContactSurfaces surfaces)
      : mesh(step_mesh),
        options(step_options),
        contacts(step_mesh, step_options, std::move(surfaces)),
        hierarchy(step_mesh),
        parts(step_mesh),
        faces(step_mesh),
        straight(step_mesh, faces),
        proximities(step_mesh, contacts, faces) {}

  const Mesh& mesh;
  CollisionOptions options;
  ContactTable contacts;
  BoxHierarchy hierarchy;
  SurfaceParts parts;
  VertexFaces faces;
  StraightSurfaces straight;
  StartProximities proximities;
  std::vector<RepulsionContact> room_of_found;
  Contacts room_of_swept;
  std::atomic_flag in_use;
};

/// The near pairs as contacts, as they stand at the start of a step from V_t0. In room_of_found, which grows as it
/// must.
[[nodiscard]] std::span<const RepulsionContact> make_contacts(const std::vector<PairProximity>& pairs,
                                                              const Positions& V_t0,
                                                              std::span<const double> inverse_mass,
                                                              const std::vector<std::uint8_t>& is_cloth,
                                                              StepContext& context);

/// With a given set of waiting bodies.
class CollisionAttempt {
 public:
  /// All must outlive it.
  CollisionAttempt(StepContext& context, const CollisionBodies& bodies, ScriptedGroups& groups, double dt_s,
                   const Patience& patience, std::span<const RepulsionContact> held);

  /// The report says how it ended; a conflict where the fail-safe ends in one.
  std::optional<StepLimiter::Conflict> run(const PositionsRef& V_t0, const PositionsRef& V_candidate);

  /// After run().
  [[nodiscard]] const StepMotion& motion() const { return motion_; }
  [[nodiscard]] CollisionStepReport& report() { return report_; }
  [[nodiscard]] const CollisionTracker& tracker() const { return tracker_; }
  [[nodiscard]] std::vector<RepulsionContact>& met() { return met_; }
  /// Of all runs; unsorted, with repeats.
  [[nodiscard]] std::vector<VertexId>& without_room() { return without_room_; }

 private:
  void repel();
  bool search();
  void meet_collisions();
  void apply_impulses();
  void move_impact_zones();
  std::optional<StepLimiter::Conflict> hold_back();
  void add_without_room(std::span<const VertexId> vertices);
  void add_colliding();
  [[nodiscard]] bool zone_can_help(const Collision& collision) const;

  StepContext& context_;
  const CollisionBodies& bodies_;
  ScriptedGroups& groups_;
  const double dt_s_;
  const Patience patience_;
  const std::span<const RepulsionContact> held_;
  std::vector<RepulsionContact> met_;  ///< beside held_
  std::vector<VertexId> without_room_;
  const std::vector<std::uint8_t> surface_;
  StepMotion motion_;
  CollisionTracker tracker_;
  ParallelUpdate update_;
  CollisionStepReport report_;
};

}  // namespace selvage::sim
