#include "fuzz/kept/scene_case.h"

#include <charconv>

#include "fuzz/draw/step_world.h"
#include "fuzz/oracle/check_facts.h"
#include "io/error.h"
#include "sim/scene/scene_reader.h"
#include "sim/step.h"

namespace selvage::fuzz {
namespace {

constexpr std::int64_t kMaxSteps = 1000000;

verify::Topology topology_of(const sim::World& world) {
  const std::vector<std::uint8_t> is_body = io::body_faces(world.triangles.size(), world.groups);
  return verify::make_topology({world.triangles, is_body}, static_cast<std::size_t>(world.x_t0.rows()));
}

/// Violations of the motion and of the frame at its end.
bool touches(const verify::Topology& topology, const Positions& x_t0, const Positions& x_t1, const std::string& what,
             std::vector<std::string>& facts) {
  const std::vector<verify::Point> before = sim::points_of(x_t0), after = sim::points_of(x_t1);
  const verify::CheckResult motion = verify::check_motion(topology, before, after, {});
  const verify::CheckResult frame = verify::check_frame(topology, after, {});
  if (motion.violations_total.total() != 0) append_facts(facts, "the motion of " + what, motion);
  if (frame.violations_total.total() != 0) append_facts(facts, "the frame after " + what, frame);
  return motion.violations_total.total() + frame.violations_total.total() != 0;
}

std::int64_t steps_of(const std::string& word) {
  std::int64_t steps = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), steps);
  const bool is_count = error == std::errc() && end == word.data() + word.size() && steps >= 1 && steps <= kMaxSteps;
  return is_count ? steps : 0;
}

bool is_steps(const std::string& word) { return steps_of(word) > 0; }

Retrial retry_scene(const ByteCase& kept) {
  try {
    return try_scene(kept.bytes, steps_of(kept.value)).retrial;
  } catch (const io::Error& error) {
    return {{}, {}, error.what()};
  }
}

}  // namespace

const ByteKind& scene_kind() {
  static const ByteKind kind{"simulation",
                             "random scenes stay free of intersections, frame by frame and step by step (S1, S4)",
                             "steps", is_steps, retry_scene};
  return kind;
}

ByteCase scene_case(std::string scene, std::int64_t steps) {
  return {&scene_kind(), std::to_string(steps), std::move(scene)};
}

SceneTrial try_scene(const std::string& text, std::int64_t steps, std::int64_t jammed) {
  const sim::Scene scene = sim::parse_scene(text, "the scene of the case");
  sim::Simulation simulation(scene);
  const verify::Topology topology = topology_of(simulation.world());
  SceneTrial trial;
  std::vector<std::string>& facts = trial.retrial.facts;
  if (touches(topology, simulation.x(), simulation.x(), "the start", facts)) {
    trial.retrial.unfit = "the scene begins in contact";
    return trial;
  }
  while (trial.steps < steps && jammed > 0 && simulation.clock().frame() < scene.time.frame_count) {
    const Positions x_t0 = simulation.x();
    const sim::CollisionStepReport report = simulation.step().report;
    if (report.status == sim::StepStatus::kInvalidInput) {
      trial.retrial.failure = "invalid-candidates";
      return trial;
    }
    ++trial.steps;
    trial.with_collisions += report.first_collisions > 0;
    trial.with_zones += report.zone_rounds > 0;
    trial.with_fail_safe += report.fail_safe_vertices > 0;
    jammed -= report.zone_rounds > 0 || report.fail_safe_vertices > 0;
    if (touches(topology, x_t0, simulation.x(), "step " + std::to_string(trial.steps), facts)) {
      trial.retrial.failure = "touches";
      return trial;
    }
    trial.stopped = report.status == sim::StepStatus::kStopped;
    if (trial.stopped) break;
  }
  facts.push_back(std::to_string(trial.steps) + " steps, each frame and each motion exactly free of touching" +
                  (trial.stopped ? ", then the simulation stopped" : ""));
  return trial;
}

}  // namespace selvage::fuzz
