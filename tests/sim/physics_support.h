// What tests of whole scenes share.
#pragma once

#include <cmath>
#include <string>

#include "sim/step.h"

namespace selvage::sim::testbed {

inline constexpr double kGravity = 9.81;

/// A small soft sheet; `more` goes to its table.
inline std::string sheet(const std::string& name, double z, double velocity_z, const std::string& more = "") {
  return "[[cloth]]\nname = \"" + name +
         "\"\nsheet = {nx = 7, ny = 7, width_m = 0.12, height_m = 0.12}\nposition_m = [0.004, 0.003, " +
         std::to_string(z) + "]\nrotation_deg = [0, 0, 10]\nvelocity_m_s = [0.2, 0, " + std::to_string(velocity_z) +
         "]\ndensity_kg_m2 = 0.2\nstretch_n_m = 20\nshear_n_m = 10\nbend_n_m = 0.2\ndamping_ratio = 0.2\n" + more;
}

/// Gravity in the frame of a plane that slopes along x.
inline std::string tilted_gravity(double slope) {
  const double down = kGravity / std::hypot(1, slope);
  return "gravity_m_s2 = [" + std::to_string(slope * down) + ", 0, " + std::to_string(-down) + "]\n";
}

inline std::string plane() {
  return "[[body]]\nname = \"plane\"\nsheet = {nx = 2, ny = 2, width_m = 4, height_m = 4}\n";
}

inline Vec3 mean(const Positions& rows, VertexId begin, VertexId end) {
  return rows.middleRows(begin, end - begin).colwise().mean().transpose();
}

/// Steps until then; where everything is.
inline const Positions& run_to(Simulation& simulation, double end_s) {
  while (simulation.clock().time_s() < end_s - 1e-9) simulation.step();
  return simulation.x();
}

}  // namespace selvage::sim::testbed
