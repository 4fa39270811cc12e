// Properties of responses: to be called inside a RapidCheck property.
#pragma once

#include <vector>

#include "sim/base/rigid_motion.h"

namespace selvage::sim::testbed {

/// Nodes of an impact zone.
struct Nodes {
  std::vector<Vec3> x, displacement;
  std::vector<double> inverse_mass;
};

enum class ZoneShape { kSpread, kLine, kPoint };
Nodes random_nodes(ZoneShape shape, double speed);
std::vector<Vec3> displacements(const RigidMotion& rigid, const std::vector<Vec3>& x);

void prop_impulse_does_what_is_asked();
void prop_repulsion_ends_the_approach();
void prop_friction_keeps_momenta_and_the_cone();
void prop_zone_keeps_distances_and_momentum(ZoneShape shape);
void prop_far_zone_keeps_distances_and_momentum(ZoneShape shape);
void prop_zone_keeps_angular_momentum(ZoneShape shape);

}  // namespace selvage::sim::testbed
