// Closed and open surfaces that scenes do not name.
#pragma once

#include "sim/scene/shapes.h"

namespace selvage::bench {

/// A closed cone of `facets` sides: its tip at the origin, its flat end at z = height.
[[nodiscard]] sim::Shape make_spike(int facets, double radius_m, double height_m);

/// A closed prism over a triangle: its ridge along y through the origin, `cells` long, its flat side at z = height.
[[nodiscard]] sim::Shape make_wedge(int cells, double length_m, double width_m, double height_m);

/// A tube about the x axis, open at both ends; vertex (ring, i) is number ring * facets + i.
[[nodiscard]] sim::Shape make_tube(int rings, int facets, double length_m, double radius_m);

/// The shape turned by 180 degrees about the x axis.
[[nodiscard]] sim::Shape upside_down(sim::Shape shape);
[[nodiscard]] sim::Shape turned(sim::Shape shape, const Vec3& rotation_deg);

}  // namespace selvage::bench
