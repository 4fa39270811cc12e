// Properties of responses: to be called inside a RapidCheck property.
#pragma once

#include <vector>

#include "sim/base/rigid_motion.h"

namespace selvage::sim::testing {

/// Nodes of an impact zone.
struct Nodes {
  std::vector<Vec3> x, displacement;
  std::vector<double> inverse_mass;
};

enum class Shape { kSpread, kLine, kPoint };
Nodes random_nodes(Shape shape, double speed);
std::vector<Vec3> displacements(const RigidMotion& rigid, const std::vector<Vec3>& x);

void prop_impulse_does_what_is_asked();
void prop_repulsion_ends_the_approach();
void prop_friction_keeps_momenta_and_the_cone();
void prop_zone_keeps_distances_and_momentum(Shape shape);
void prop_zone_keeps_angular_momentum(Shape shape);

}  // namespace selvage::sim::testing
