#include "bench/stability/hard_shapes.h"

#include <cmath>
#include <numbers>

#include "sim/scene/rigid_path.h"

namespace selvage::bench {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

}  // namespace

sim::Shape make_spike(int facets, double radius_m, double height_m) {
  sim::Shape spike;
  spike.x.resize(facets + 2, 3);
  spike.x.row(0).setZero();
  spike.x.row(1) << 0, 0, height_m;
  for (int i = 0; i < facets; ++i) {
    spike.x.row(i + 2) << radius_m * std::cos(kTurn * i / facets), radius_m * std::sin(kTurn * i / facets), height_m;
    const int here = i + 2, next = (i + 1) % facets + 2;
    spike.triangles.push_back({0, next, here});
    spike.triangles.push_back({1, here, next});
  }
  return spike;
}

sim::Shape make_wedge(int cells, double length_m, double width_m, double height_m) {
  sim::Shape wedge;
  wedge.x.resize(3 * (cells + 1), 3);
  for (int i = 0; i <= cells; ++i) {
    const double y = (double(i) / cells - 0.5) * length_m;
    wedge.x.row(3 * i) << 0, y, 0;
    wedge.x.row(3 * i + 1) << width_m / 2, y, height_m;
    wedge.x.row(3 * i + 2) << -width_m / 2, y, height_m;
  }
  for (int i = 0; i < cells; ++i) {
    for (int side = 0; side < 3; ++side) {
      const int a = 3 * i + side, b = 3 * i + (side + 1) % 3;
      wedge.triangles.push_back({a, a + 3, b});
      wedge.triangles.push_back({b, a + 3, b + 3});
    }
  }
  wedge.triangles.push_back({0, 1, 2});
  wedge.triangles.push_back({3 * cells, 3 * cells + 2, 3 * cells + 1});
  return wedge;
}

sim::Shape make_tube(int rings, int facets, double length_m, double radius_m) {
  sim::Shape tube;
  tube.x.resize(Eigen::Index{rings} * facets, 3);
  for (int ring = 0; ring < rings; ++ring) {
    for (int i = 0; i < facets; ++i) {
      const double angle = kTurn * (i + 0.5 * (ring % 2)) / facets;
      tube.x.row(ring * facets + i) << (double(ring) / (rings - 1) - 0.5) * length_m, radius_m * std::cos(angle),
          radius_m * std::sin(angle);
      if (ring + 1 == rings) continue;
      const int next = (i + 1) % facets, a = ring * facets + i, b = ring * facets + next;
      const int c = a + facets, d = b + facets;
      if (ring % 2 == 0) {
        tube.triangles.push_back({a, b, c});
        tube.triangles.push_back({b, d, c});
      } else {
        tube.triangles.push_back({a, b, d});
        tube.triangles.push_back({a, d, c});
      }
    }
  }
  return tube;
}

sim::Shape upside_down(sim::Shape shape) {
  shape.x.rightCols(2) *= -1;  // a turn, so orientations stay
  return shape;
}

sim::Shape turned(sim::Shape shape, const Vec3& rotation_deg) {
  shape.x = sim::place({Vec3::Zero(), rotation_deg}, shape.x);
  return shape;
}

}  // namespace selvage::bench
