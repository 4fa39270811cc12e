#include "bench/stability/scene_play.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "sim/scene/scene_reader.h"

namespace selvage::bench {
namespace {

sim::Scene moved_scene(const std::string& toml, const Vec3& offset) {
  sim::Scene scene = sim::parse_scene(toml, "stability case", sim::Quality::kDraft);
  for (sim::ClothSpec& cloth : scene.cloths) cloth.placement.position_m += offset;
  for (sim::BodySpec& body : scene.bodies) {
    if (!body.parent) body.script.placement.position_m += offset;
  }
  return scene;
}

}  // namespace

std::string scene_start(double drag_1_s, double friction, const std::string& more) {
  return fmt::format(R"(gravity_m_s2 = [0, 0, -9.81]
drag_1_s = {}
{}[time]
frames_per_s = 30
frames = 200
max_step_s = 0.0166667
[collision]
thickness_m = 0.004
friction_static = {}
)",
                     drag_1_s, more, friction);
}

ScenePlay::ScenePlay(Trial& trial, const std::string& toml, double length_m)
    : offset_(trial.offset(length_m)),
      simulation_(moved_scene(toml, offset_)),
      watch_(trial, simulation_.world().triangles,
             io::body_faces(simulation_.world().triangles.size(), simulation_.world().groups),
             simulation_.world().mesh.vertex_count, simulation_.scene().collision) {
  watch_.start(simulation_.x());
}

const sim::StepResult& ScenePlay::step() {
  const Positions x_t0 = simulation_.x();
  last_ = simulation_.step();
  watch_.step(x_t0, simulation_.x(), last_.report);
  return last_;
}

void ScenePlay::run_to(double time_s) {
  while (simulation_.clock().time_s() < time_s) step();
}

double ScenePlay::fastest_m_s() const {
  return simulation_.state().v.topRows(simulation_.world().cloth_vertex_count).rowwise().norm().maxCoeff();
}

double ScenePlay::largest_strain() const { return sim::most_strained(simulation_.world().springs, x()).strain; }

}  // namespace selvage::bench
