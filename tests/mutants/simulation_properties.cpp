// A whole simulation: every step exact (S1), scripts followed (S4), velocities true, and the same bits for any number
// of threads, from a checkpoint, and in the files (K7, S5).
#include <oneapi/tbb/task_arena.h>

#include "fuzz/draw/step_world.h"
#include "io/file/atomic_file.h"
#include "io/sequence.h"
#include "sim/record/recorder.h"
#include "sim/scene/scene_reader.h"
#include "tests/mutants/properties.h"
#include "tests/temporary_folder.h"
#include "verify/check.h"

namespace selvage::mutants {
namespace {

constexpr double kGravity = 9.81;

/// A sheet that falls onto a turning ball, with random sizes, in steps that must be halved now and then. In half of the
/// scenes a step is one of the dynamics at most, which then holds no contacts.
std::string scene_text(std::uint64_t seed) {
  fuzz::ChoiceSource source = fuzz::ChoiceSource::from_seed(seed);
  const auto number = [&](int first, int last, double unit) {
    return std::to_string(source.range(first, last) * unit);
  };
  const std::string side = std::to_string(source.range(4, 7));
  std::string text = "gravity_m_s2 = [0, 0, -9.81]\nstrain_limit = 0\nstrain_rate_limit = 0\n";
  text += "[time]\nframes_per_s = 30\nframes = 8\n";
  text +=
      source.coin() ? "min_step_s = 0.004\n" : "min_step_s = 0.001\nmax_step_s = 0.0084\ndynamics_step_s = 0.0084\n";
  text += "[collision]\nthickness_m = 0.005\n";
  text += "friction_static = " + number(0, 5, 0.1) + "\n";
  if (source.coin()) text += "precision = \"float32\"\n";
  text += "[[cloth]]\nsheet = {nx = " + side + ", ny = " + side + ", width_m = 0.4, height_m = 0.4}\n";
  const std::string z = number(31, 36, 0.01), y = number(0, 8, 0.01), x = number(0, 8, 0.01);
  text += "position_m = [" + x + ", " + y + ", " + z + "]\n";
  const std::string speed = number(-5, -1, 1.0), angle = number(0, 45, 1.0);
  text += "rotation_deg = [0, 0, " + angle + "]\nvelocity_m_s = [0, 0, " + speed + "]\n";
  text += "density_kg_m2 = 2\nstretch_n_m = 15\nshear_n_m = 5\ndamping_ratio = 0.1\n";
  text += "[[body]]\nname = \"ball\"\nsphere = {radius_m = 0.15, subdivisions = 1}\n";
  text +=
      "[[body.key]]\ntime_s = 0\nposition_m = [0, 0, 0.15]\n[[body.key]]\ntime_s = 1\nposition_m = [0.3, 0, 0.15]\n";
  return text + "rotation_deg = [0, 90, 0]\n";
}

sim::Simulation make_simulation(std::uint64_t seed) {
  return sim::Simulation(sim::parse_scene(scene_text(seed), "drawn.toml"));
}

bool runs(const sim::Simulation& simulation) {
  return simulation.clock().frame() < simulation.scene().time.frame_count;
}

verify::Surface surface_of(const sim::World& world, std::vector<std::uint8_t>& is_body) {
  is_body = io::body_faces(world.triangles.size(), world.groups);
  return {world.triangles, is_body};
}

/// Momentum of the cloth in kg m/s, for velocities or anything else that the masses weigh.
Vec3 weighed(const sim::World& world, const Positions& v) {
  Vec3 sum = Vec3::Zero();
  for (Eigen::Index i = 0; i < world.cloth_vertex_count; ++i) {
    sum += v.row(i).transpose() / world.inverse_mass[static_cast<std::size_t>(i)];
  }
  return sum;
}

std::string judge_step(const sim::Simulation& simulation, const sim::SimulationState& before,
                       const sim::StepResult& step) {
  const sim::World& world = simulation.world();
  if (step.report.status != sim::StepStatus::kSafe) return "a step was not safe";
  std::vector<std::uint8_t> is_body;
  const verify::Surface surface = surface_of(world, is_body);
  const auto points = sim::points_of(simulation.x());
  if (verify::check_motion(surface, sim::points_of(before.x), points, {}).violations_total.total() != 0 ||
      verify::check_frame(surface, points, {}).violations_total.total() != 0) {
    return "a step touches";
  }
  const sim::Precision precision = simulation.scene().collision.precision;
  Positions scripted = simulation.x();
  for (const sim::Collider& body : world.colliders) body.place_at(simulation.clock().time_s(), precision, scripted);
  if (scripted != simulation.x()) return "off script";
  // Springs keep the cloth's momentum: but for contacts that act within the dynamics, the end of the step is half a
  // step of gravity faster than its mean (7.6).
  const Positions moved = simulation.x() - before.x;
  const double mass = weighed(world, Positions::Ones(moved.rows(), 3)).x();
  const Vec3 mean = weighed(world, moved) / step.dt_s;
  const Vec3 half_gravity(0, 0, -kGravity * step.dt_s / 2 * mass);
  const Vec3 off = weighed(world, simulation.state().v) - mean - half_gravity;
  const double rounding = precision == sim::Precision::kFloat32 ? 1e-6 * mass / step.dt_s : 1e-6 * half_gravity.norm();
  if (step.held_repulsions == 0 && off.norm() > rounding) return "velocities are not those of the motion";
  return simulation.state().clock.frame == 0 && simulation.state().clock.tick == 0 ? "the clock stands" : "";
}

std::string judge_simulation(std::uint64_t seed) {
  sim::Simulation simulation = make_simulation(seed);
  while (runs(simulation)) {
    const sim::SimulationState before = simulation.state();
    const sim::StepResult step = simulation.step();
    if (std::string what = judge_step(simulation, before, step); !what.empty()) return what;
  }
  return "";
}

Positions end_with(std::uint64_t seed, int threads) {
  return oneapi::tbb::task_arena(threads).execute([seed] {
    sim::Simulation simulation = make_simulation(seed);
    while (runs(simulation)) (void)simulation.step();
    return simulation.x();
  });
}

std::string compare_run_threads(std::uint64_t seed) {
  return end_with(seed, 1) == end_with(seed, 3) ? "" : "other bits";
}

/// Records every step; half-way the run is dropped and a new process would go on from the checkpoint.
std::string judge_recording(std::uint64_t seed) {
  const testing::TemporaryFolder folder;
  sim::Scene scene = sim::parse_scene(scene_text(seed), "drawn.toml");
  scene.file = folder.path() / "drawn.toml";
  io::write_atomically(scene.file, scene_text(seed));
  std::vector<Positions> states;
  {
    sim::Simulation whole(scene);
    states.push_back(whole.x());
    while (runs(whole)) {
      (void)whole.step();
      states.push_back(whole.x());
    }
  }
  for (const bool resume : {false, true}) {
    sim::Simulation part(scene);
    sim::Recorder recorder(folder.path() / "run", part, io::SequenceKind::kSteps, resume, "selvage");
    recorder.begin();
    const auto stop = resume ? scene.time.frame_count : scene.time.frame_count / 2 + 1;
    while (part.clock().frame() < stop) recorder.record(part.step());
  }
  const auto sequence = io::open_sequence({folder.path() / "run"}, {});
  if (sequence->frame_count() != states.size()) return "steps were lost or repeated";
  for (std::size_t i = 0; i < states.size(); ++i) {
    if (sequence->frame(i).points != sim::points_of(states[i])) return "a recorded step has other bits";
  }
  return "";
}

}  // namespace

std::vector<Property> simulation_properties() {
  return {{"simulation", "every step is exactly free, on script, with the velocities of its motion (S1, S3, S4)",
           falsify<judge_simulation>},
          {"simulation-threads", "a simulation gives the same bits for 1 and for 3 threads (K7)",
           falsify<compare_run_threads>, true},
          {"recording", "what is recorded and resumed has the bits of a run in one go (S5)", falsify<judge_recording>}};
}

}  // namespace selvage::mutants
