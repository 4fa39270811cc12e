// Where a body is that may hang on another: forward kinematics.
#pragma once

#include <vector>

#include "sim/scene/rigid_path.h"

namespace selvage::sim {

/// A chain of motions, each relative to the next: a key frame turns about a joint, the joint stands in the parent, and
/// the parent moves by its own chain.
class Linkage {
 public:
  /// In the world: x_world = placement(path(t)(x)).
  Linkage(const Pose& placement, RigidPath path);
  /// The same in the frame of `parent`.
  Linkage(const Pose& placement, RigidPath path, const Linkage& parent);

  /// The bits are those of the path alone where it has no parent and the placement is zero.
  [[nodiscard]] RigidFrame at(double time_s) const;
  /// Of all its motions (RigidPath): the times of keys, in any order; how far they turn together, degrees.
  [[nodiscard]] std::vector<double> keys_between(double t0_s, double t1_s) const;
  [[nodiscard]] double turn_deg(double t0_s, double t1_s) const;

 private:
  struct Link {
    RigidFrame placement;
    RigidPath path;
  };
  std::vector<Link> links_;  ///< the body's own, then its parent's, up to the world
};

}  // namespace selvage::sim
