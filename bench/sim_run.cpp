#include "bench/sim_run.h"

#include <cmath>
#include <optional>
#include <stdexcept>

#include <Eigen/Geometry>

#include "bench/timed.h"
#include "sim/subdivision/subdivision.h"

namespace selvage::bench {
namespace {

struct Conserved {
  double kinetic = 0, energy = 0;
  Vec3 momentum = Vec3::Zero(), angular = Vec3::Zero();
  double momentum_scale = 0, angular_scale = 0;  ///< sum m |v|, sum m |x| |v|
  double strain = 0;
};

/// Of the cloth's vertices that have a mass; held ones do not move in the scenes that ask.
Conserved conserved(const sim::Simulation& simulation, const Vec3& centre) {
  const sim::World& world = simulation.world();
  const sim::SimulationState state = simulation.state();
  Conserved sum;
  for (Eigen::Index i = 0; i < world.cloth_vertex_count; ++i) {
    const double w = world.inverse_mass[static_cast<std::size_t>(i)];
    if (w == 0) continue;
    const Vec3 x = state.x.row(i).transpose() - centre, v = state.v.row(i);
    sum.kinetic += v.squaredNorm() / (2 * w);
    sum.energy -= simulation.scene().gravity_m_s2.dot(x) / w;
    sum.momentum += v / w;
    sum.angular += x.cross(v) / w;
    sum.momentum_scale += v.norm() / w;
    sum.angular_scale += x.norm() * v.norm() / w;
  }
  for (const sim::Spring& spring : world.springs.springs()) {
    sum.energy += elastic_j(spring, state.x);
  }
  sum.strain = sim::most_strained(world.springs, state.x).strain;
  sum.energy += sum.kinetic;
  return sum;
}

Vec3 centre_of_mass(const sim::World& world) {
  Vec3 sum = Vec3::Zero();
  double mass = 0;
  for (Eigen::Index i = 0; i < world.cloth_vertex_count; ++i) {
    const double w = world.inverse_mass[static_cast<std::size_t>(i)];
    if (w == 0) continue;
    sum += world.x_t0.row(i).transpose() / w;
    mass += 1 / w;
  }
  return sum / mass;
}

class Drifts {
 public:
  explicit Drifts(const sim::Simulation& simulation)
      : centre_(centre_of_mass(simulation.world())), start_(conserved(simulation, centre_)) {
    least_energy_ = start_.energy;
    largest_kinetic_ = start_.kinetic;
  }

  void look(const sim::Simulation& simulation) {
    const Conserved now = conserved(simulation, centre_);
    largest_kinetic_ = std::max(largest_kinetic_, now.kinetic);
    drift_ = std::max(drift_, std::abs(now.energy - start_.energy));
    gain_ = std::max(gain_, now.energy - least_energy_);
    least_energy_ = std::min(least_energy_, now.energy);
    momentum_ = std::max(momentum_, (now.momentum - start_.momentum).norm());
    angular_ = std::max(angular_, (now.angular - start_.angular).norm());
    strain_ = std::max(strain_, now.strain);
  }

  void fill(SimRun& run) const {
    const auto share = [](double part, double whole) { return whole > 0 ? part / whole : 0; };
    run.energy_drift = share(drift_, largest_kinetic_);
    run.energy_gain = share(gain_, largest_kinetic_);
    run.momentum_drift = share(momentum_, start_.momentum_scale);
    run.angular_momentum_drift = share(angular_, start_.angular_scale);
    run.strain = strain_;
  }

 private:
  Vec3 centre_;
  Conserved start_;
  double least_energy_ = 0, largest_kinetic_ = 0, drift_ = 0, gain_ = 0, momentum_ = 0, angular_ = 0, strain_ = 0;
};

}  // namespace

SimRun run_simulation(const sim::Scene& scene, const SimRunOptions& options) {
  sim::Simulation simulation(scene);
  const sim::World& world = simulation.world();
  std::optional<sim::Subdivision> subdivision;
  if (options.subdivision_levels > 0) {
    subdivision.emplace(world.triangles, world.mesh.vertex_count, world.groups, options.subdivision_levels);
  }
  SimRun run;
  run.vertices = world.cloth_vertex_count;
  Drifts drifts(simulation);
  while (simulation.clock().frame() < scene.time.frame_count && run.steps < options.most_steps) {
    sim::StepResult step;
    BestTime taken;
    time(taken, [&] {
      step = simulation.step();
      if (subdivision && simulation.clock().at_frame()) {
        sim::SubdivisionCounts counts;
        run.fine_vertices = (*subdivision)(simulation.x(), counts).rows();
      }
    });
    if (step.report.status != sim::StepStatus::kSafe) throw std::runtime_error("bench sim: a step was not safe");
    run.cpu_ns += taken.cpu;
    run.wall_ns += taken.wall;
    run.phases += step.phases;
    run.contacts += step.report.repulsions + step.report.frictions + step.report.first_collisions;
    run.fail_safe_vertices += step.report.fail_safe_vertices;
    ++run.steps;
    if (simulation.clock().at_frame()) drifts.look(simulation);
  }
  run.frames = simulation.clock().frame();
  drifts.fill(run);
  run.x = simulation.x().topRows(world.cloth_vertex_count);
  return run;
}

}  // namespace selvage::bench
