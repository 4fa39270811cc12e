#include "bench/sim_scenes.h"

#include <fmt/format.h>

#include "sim/scene/scene_reader.h"

namespace selvage::bench {
namespace {

sim::Scene parse(sim::Solver solver, const std::string& rest) {
  return sim::parse_scene(fmt::format("solver = \"{}\"\n{}", solver_name(solver), rest), "bench sim");
}

/// The two tables that all sheets share; keys of a table may follow.
std::string sheet(int nodes, double side_m, double stretch_n_m) {
  return fmt::format(
      "[[cloth]]\nsheet = {{nx = {0}, ny = {0}, width_m = {1}, height_m = {1}}}\ndensity_kg_m2 = 0.2\n"
      "stretch_n_m = {2}\nshear_n_m = {3}\n",
      nodes, side_m, stretch_n_m, stretch_n_m / 3);
}

std::string time_table(int frames, const std::string& more) {
  return fmt::format("[time]\nframes_per_s = {}\nframes = {}\n{}", kFramesPerSecond, frames, more);
}

constexpr double kBallRadius = 0.4, kDrapeSide = 1.6;
constexpr const char* kBall = "[[body]]\nname = \"ball\"\nsphere = {radius_m = 0.4, subdivisions = 4}\n";
constexpr const char* kGravity = "gravity_m_s2 = [0, 0, -9.81]\n";

/// Just above the top of the ball, which it meets in the first step.
std::string falling() {
  return fmt::format("position_m = [0, 0, {}]\nvelocity_m_s = [0, 0, -2]\n", kBallRadius + 0.01);
}

}  // namespace

const char* solver_name(sim::Solver solver) { return solver == sim::Solver::kExplicit ? "explicit" : "implicit"; }

sim::Scene swing_scene(sim::Solver solver, int nodes, int substeps) {
  const double step_s = 1 / kFramesPerSecond / substeps;
  return parse(solver,
               std::string(kGravity) + "strain_limit = 0\n" +
                   (solver == sim::Solver::kExplicit ? "strain_rate_limit = 0\n" : "") +
                   time_table(8, fmt::format("dynamics_step_s = {}\nmax_step_s = {}\n", step_s, 1 / kFramesPerSecond)) +
                   "[collision]\nrepulsion = false\n" + sheet(nodes, kSwingSide, 60) +
                   "[[cloth.pin]]\nedge = \"top\"\n");
}

sim::Scene meeting_scene(sim::Solver solver) {
  const auto one = [](const char* name, double z, double velocity, double turn_deg) {
    return sheet(17, 0.5, 60) + fmt::format(
                                    "name = \"{}\"\nposition_m = [0.03, 0.02, {}]\nvelocity_m_s = [0.3, 0, {}]\n"
                                    "rotation_deg = [0, 0, {}]\n",
                                    name, z, velocity, turn_deg);
  };
  return parse(solver, time_table(15, "max_step_s = 0.0084\n") +
                           "[collision]\nthickness_m = 0.004\nfriction_static = 0.3\n" + one("upper", 0.01, -1, 20) +
                           one("lower", -0.01, 1, 0));
}

sim::Scene stretch_scene(sim::Solver solver) {
  return parse(solver, std::string(kGravity) + time_table(20, "") + sheet(17, 0.5, 4) +
                           "damping_ratio = 0.1\n[[cloth.pin]]\nedge = \"top\"\n[[cloth.pin]]\nedge = \"bottom\"\n");
}

sim::Scene drape_scene(sim::Solver solver, int nodes) {
  return parse(solver, std::string(kGravity) + "drag_1_s = 0.3\n" + time_table(3, "max_step_s = 0.0167\n") +
                           "[collision]\nthickness_m = 0.002\nfriction_static = 0.4\n" + sheet(nodes, kDrapeSide, 60) +
                           "bend_n_m = 0.6\ndamping_ratio = 0.1\n" + falling() + kBall);
}

std::vector<ModuleScene> module_scenes(int nodes) {
  struct Parts {
    std::string top = "strain_limit = 0\nstrain_rate_limit = 0\n", time = "max_step_s = 0.0167\nmin_step_s = 0.0167\n",
                collision = "repulsion = false\n", cloth, bodies;
  } parts;
  std::vector<ModuleScene> scenes;
  const auto add = [&](const char* name) {
    const std::string text = kGravity + parts.top + time_table(12, parts.time) + "[collision]\nthickness_m = 0.002\n" +
                             parts.collision + sheet(nodes, kDrapeSide, 60) + falling() + parts.cloth + parts.bodies;
    scenes.push_back({name, parse(sim::Solver::kExplicit, text), 0});
  };
  add("springs alone");
  add("nothing: the same again");
  parts.cloth += "bend_n_m = 0.6\n";
  add("bending");
  parts.cloth += "damping_ratio = 0.1\n";
  add("damping");
  parts.top = "";
  add("strain limits");
  parts.collision = "";
  add("repulsions of the cloth itself");
  parts.bodies = kBall;
  add("a ball");
  parts.collision = "friction_static = 0.4\n";
  add("friction");
  parts.time = "max_step_s = 0.0167\n";
  add("adaptive step");
  parts.collision += "precision = \"float32\"\n";
  add("float32 positions");
  scenes.push_back({"a level of subdivision", scenes.back().scene, 1});
  return scenes;
}

}  // namespace selvage::bench
