#include "fuzz/simulation_campaign.h"

#include "fuzz/random_scene.h"
#include "fuzz/step_world.h"
#include "sim/scene_reader.h"
#include "sim/step.h"
#include "verify/check.h"

namespace selvage::fuzz {
namespace {

constexpr int kSteps = 80;  ///< of a case at most

verify::Topology topology_of(const sim::World& world) {
  std::vector<std::uint8_t> is_body(world.triangles.size());
  for (const io::Group& group : world.groups) {
    if (group.role != io::Group::Role::kBody) continue;
    for (std::int32_t face = group.face_begin; face < group.face_end; ++face)
      is_body[static_cast<std::size_t>(face)] = 1;
  }
  return verify::make_topology({world.triangles, is_body}, static_cast<std::size_t>(world.x_t0.rows()));
}

class SimulationCampaign final : public Property {
 public:
  SimulationCampaign()
      : Property("simulation", "random scenes stay free of intersections, frame by frame and step by step (S1, S4)") {
    weight_ = 2;
    for (const std::string_view name : scene_classes()) streams_.push_back({std::string(name), 0, 1});
    counters_ = {"steps", "collisions", "zones", "fail-safe", "stopped", "not started"};
  }

  Outcome run(const Stream& stream, ChoiceSource source) override {
    const sim::Scene scene = sim::parse_scene(random_scene(stream.name, source), "random scene");
    sim::Simulation simulation(scene);
    const verify::Topology topology = topology_of(simulation.world());
    Outcome outcome{{1, 0, {}, 0}, {}};
    auto& [steps, collisions, zones, fail_safe, stopped, not_started, unused_0, unused_1] = outcome.counts.of;
    if (check(topology, simulation.x(), simulation.x()) != 0) {
      not_started = 1;  // the scene begins in contact, which the program refuses
      return outcome;
    }
    while (steps < kSteps && simulation.clock().state().frame < scene.time.frame_count) {
      const Positions x_t0 = simulation.x();
      const sim::CollisionStepReport report = simulation.step().report;
      if (report.status == sim::StepStatus::kInvalidInput) return failed(outcome, "invalid-candidates");
      ++steps;
      collisions += report.first_collisions > 0;
      zones += report.zone_rounds > 0;
      fail_safe += report.fail_safe_vertices > 0;
      if (check(topology, x_t0, simulation.x()) != 0) return failed(outcome, "touches");
      if (report.status == sim::StepStatus::kStopped) {
        stopped = 1;
        return outcome;
      }
    }
    return outcome;
  }

  [[nodiscard]] std::string complaint(const Stream& /*stream*/, const Counts& counts) const override {
    return counts.cases > 20 && counts.of[5] * 2 > counts.cases ? "most scenes begin in contact" : "";
  }

  std::string kept(const Stream& stream, ChoiceSource source, const std::string& origin, const std::string& failure,
                   bool /*shrunk*/) override {
    return "# " + origin + ": " + failure + "\n" + random_scene(stream.name, source);
  }

 private:
  static Outcome failed(Outcome outcome, std::string what) {
    outcome.counts.failures = 1;
    outcome.failure = std::move(what);
    return outcome;
  }

  /// Violations of the motion and of the frame at its end.
  static std::int64_t check(const verify::Topology& topology, const Positions& x_t0, const Positions& x_t1) {
    const std::vector<verify::Point> before = raw_points(x_t0), after = raw_points(x_t1);
    return verify::check_motion(topology, before, after, {}).violations_total.total() +
           verify::check_frame(topology, after, {}).violations_total.total();
  }
};

}  // namespace

std::unique_ptr<Property> make_simulation_campaign() { return std::make_unique<SimulationCampaign>(); }

}  // namespace selvage::fuzz
