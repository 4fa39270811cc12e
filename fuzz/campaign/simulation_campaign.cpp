#include "fuzz/campaign/simulation_campaign.h"

#include <algorithm>

#include "fuzz/draw/random_scene.h"
#include "fuzz/kept/scene_case.h"
#include "fuzz/shrink/shrink_bytes.h"
#include "fuzz/shrink/shrink_choices.h"

namespace selvage::fuzz {
namespace {

constexpr std::int64_t kSceneSteps = 80;  ///< of a case at most
/// And of them, with impact zones or the fail-safe: cloth that has jammed stays so, and its steps take a hundred times
/// as long. Without this limit 3 of 2,283 cases of `fling` took more than four seconds, and one of 144 took thirteen,
/// where ten are a hang; with 20 one took 4.3.
constexpr std::int64_t kJammedSteps = 10;
/// A trial takes tenths of a second.
constexpr std::int64_t kSceneChoiceTrials = 100, kTextTrials = 300;

class SimulationCampaign final : public Property {
 public:
  SimulationCampaign() : Property("simulation", std::string(scene_kind().promise)) {
    weight_ = 2;
    for (const std::string_view name : scene_classes()) streams_.push_back({std::string(name), 0, 1});
    counters_ = {"steps", "collisions", "zones", "fail-safe", "stopped", "not started"};
  }

  Outcome run(const Stream& stream, ChoiceSource source) override {
    const SceneTrial trial = try_scene(random_scene(stream.name, source), kSceneSteps, kJammedSteps);
    Outcome outcome{{1, trial.retrial.failure.empty() ? 0 : 1, {}, 0}, trial.retrial.failure};
    auto& of = outcome.counts.of;
    of[kSteps] = trial.steps;
    of[kCollisions] = trial.with_collisions;
    of[kZones] = trial.with_zones;
    of[kFailSafe] = trial.with_fail_safe;
    of[kStopped] = trial.stopped;
    of[kNotStarted] = !trial.retrial.unfit.empty();
    return outcome;
  }

  [[nodiscard]] std::string complaint(const Stream& /*stream*/, const Counts& counts) const override {
    return counts.cases > 20 && counts.of[kNotStarted] * 2 > counts.cases ? "most scenes begin in contact" : "";
  }

  std::string kept(const Stream& stream, ChoiceSource source, const std::string& origin, const std::string& failure,
                   bool shrunk) override {
    if (!shrunk)
      return kept_text(KeptBytes(scene_case(random_scene(stream.name, source), kSceneSteps)), origin, failure);
    const Choices choices = shrink_choices(
        source, failure, [&](ChoiceSource simpler) { return run(stream, simpler).failure; }, kSceneChoiceTrials);
    ChoiceSource again = ChoiceSource::from_words(choices);
    const std::string scene = random_scene(stream.name, again);
    const ByteCase simplest =
        scene_case(scene, std::max<std::int64_t>(1, try_scene(scene, kSceneSteps, kJammedSteps).steps));
    return kept_text(KeptBytes(shrink(simplest, failure, kTextTrials)), origin, failure);
  }

 private:
  // Places in Counts::of, in the order of counters_.
  enum Counter : std::uint8_t { kSteps, kCollisions, kZones, kFailSafe, kStopped, kNotStarted };
};

}  // namespace

std::unique_ptr<Property> make_simulation_campaign() { return std::make_unique<SimulationCampaign>(); }

}  // namespace selvage::fuzz
