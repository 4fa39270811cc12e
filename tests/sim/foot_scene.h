// A foot that steps 3.5 mm too deep on a hem on the ground, under squeeze = "yield".
#pragma once

#include <string>

#include "sim/step.h"

namespace selvage::sim::testbed {

/// `foot`: the keys of its [[body]], a ball of 3 cm.
inline std::string foot_scene_text(const std::string& foot) {
  return R"(squeeze = "yield"
gravity_m_s2 = [0, 0, -9.81]
[time]
frames_per_s = 30
frames = 24
max_step_s = 0.0167
[collision]
thickness_m = 0.004
friction_static = 0.5
friction_kinetic = 0.4
[[cloth]]
sheet = {nx = 16, ny = 16, width_m = 0.4, height_m = 0.4}
position_m = [0, 0, 0.0045]
density_kg_m2 = 0.2
stretch_n_m = 60
shear_n_m = 20
damping_ratio = 0.1
[[body]]
name = "foot"
)" + foot +
         R"(
[[body]]
name = "ground"
sheet = {nx = 2, ny = 2, width_m = 20, height_m = 20}
)";
}

/// How far the vertex is from its script that is farthest, m; 0 where all are there to the bit.
inline double behind_script_m(const Simulation& simulation, const Collider& body) {
  const Positions now = simulation.x()(body.vertices(), Eigen::all);
  const Positions script = body.placed_at(simulation.clock().time_s(), Precision::kFloat64, simulation.x());
  return now == script ? 0 : (script - now).rowwise().norm().maxCoeff();
}

}  // namespace selvage::sim::testbed
