// The collisions of the step under construction, kept up to date: after a response only pairs with a vertex whose
// stored position changed are tested again. The others were decided for the very same end positions.
#pragma once

#include <cstdint>
#include <vector>

#include "kernel/collisions.h"
#include "sim/contact/contact_table.h"
#include "sim/response/step_motion.h"

namespace selvage::sim {

class CollisionTracker {
 public:
  /// `surface`: #V flags of the vertices whose pairs count (SurfaceParts::cloth_flags). Each pair is held to its own
  /// tolerance in `contacts`. The mesh, the hierarchy and the contacts must outlive it.
  CollisionTracker(const Mesh& mesh, BoxHierarchy& hierarchy, const ContactTable& contacts, std::int32_t max_intervals,
                   std::vector<std::uint8_t> surface);

  /// Tests everything. False, and nothing is known, where there are more pairs than `limits` allow.
  bool start(StepMotion& motion, const CollisionLimits& limits = {});
  /// Whether more than `most` pairs are within the largest tolerance where the motion starts. A search.
  [[nodiscard]] bool starts_with_more_near(const StepMotion& motion, std::size_t most) const;
  /// Tests what changed since the last call.
  void update(StepMotion& motion);

  /// Not separated, sorted by (kind, first, second). A pair in which nothing moves cannot touch, V_t0 being free of
  /// intersections; where the kernel could not tell, its cause is made kEnd.
  [[nodiscard]] const std::vector<Collision>& collisions() const { return report_.collisions; }
  /// How many of them the kernel cannot tell from touching where nothing in them moves.
  [[nodiscard]] std::int64_t trusted(const StepMotion& motion) const;
  /// Whether any of them is not proved free of touch.
  [[nodiscard]] bool has_motion_collision() const;
  /// The pairs above, and the queries of all calls since start().
  [[nodiscard]] const CollisionReport& report() const { return report_; }
  [[nodiscard]] std::array<VertexId, 4> vertices(const Collision& collision) const;

 private:
  [[nodiscard]] CollisionReport find(const StepMotion& motion, std::span<const std::uint8_t> active,
                                     const CollisionLimits& limits = {});
  [[nodiscard]] bool moves(const Collision& collision, const StepMotion& motion) const;
  [[nodiscard]] CcdResult ask(const Collision& pair, const StepMotion& motion, double tolerance_m) const;
  /// Asks pairs that are apart by the largest tolerance alone for their own.
  void hold_to_own_tolerance(const StepMotion& motion, CollisionReport& found) const;
  void count(const CollisionReport& found);

  const Mesh& mesh_;
  BoxHierarchy& hierarchy_;
  const ContactTable& contacts_;
  std::int32_t max_intervals_;
  std::vector<std::uint8_t> surface_;
  CollisionReport report_;
};

}  // namespace selvage::sim
