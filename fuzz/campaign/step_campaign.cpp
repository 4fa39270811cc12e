#include "fuzz/campaign/step_campaign.h"

#include "fuzz/campaign/surface_streams.h"
#include "fuzz/kept/drawn_case.h"
#include "fuzz/kept/step_case.h"
#include "fuzz/shrink/shrink_choices.h"
#include "fuzz/shrink/shrink_mesh.h"

namespace selvage::fuzz {
namespace {

constexpr std::int64_t kStepChoiceTrials = 300;  // each takes milliseconds

class StepCampaign final : public Property {
 public:
  StepCampaign() : Property("step", std::string(step_kind().promise)) {
    weight_ = 2;
    streams_ = surface_streams(4);
    counters_ = {"steps", "collisions", "zones", "fail-safe", "stopped"};
  }

  Outcome run(const Stream& stream, ChoiceSource source) override {
    const StepObservation seen = observe(stream, source);
    Outcome outcome{{1, seen.defect != StepDefect::kNone, {}, 0}, {}};
    auto& of = outcome.counts.of;
    of[kSteps] = seen.steps;
    of[kCollisions] = seen.with_collisions;
    of[kZones] = seen.with_zones;
    of[kFailSafe] = seen.with_fail_safe;
    of[kStopped] = seen.stopped;
    if (seen.defect != StepDefect::kNone) outcome.failure = name_of(seen.defect);
    return outcome;
  }

  [[nodiscard]] std::string complaint(const Stream& /*stream*/, const Counts& counts) const override {
    // Measured: half of all steps have collisions, in every class; a tenth says that they have gone.
    return counts.of[kSteps] > 500 && counts.of[kCollisions] * 10 < counts.of[kSteps] ? "hardly any collisions" : "";
  }

  std::string kept(const Stream& stream, ChoiceSource source, const std::string& origin, const std::string& failure,
                   bool shrunk) override {
    // Which of its steps failed is known only when they are run.
    if (!shrunk) return drawn_text(origin, failure);
    const Choices choices = shrink_choices(
        source, failure, [&](ChoiceSource simpler) { return run(stream, simpler).failure; }, kStepChoiceTrials);
    ChoiceSource again = ChoiceSource::from_words(choices);
    const StepWorld world = make_step_world(again, surface_class(stream.name));
    const StepObservation seen = run_steps(again, world, selvage_step);
    const MeshCase simplest = step_case(world, seen.x_t0, seen.x_candidate);
    return kept_text(KeptMesh(shrink(simplest, failure)), origin, failure);
  }

 private:
  // Places in Counts::of, in the order of counters_.
  enum Counter : std::uint8_t { kSteps, kCollisions, kZones, kFailSafe, kStopped };

  static StepObservation observe(const Stream& stream, ChoiceSource& source) {
    const StepWorld world = make_step_world(source, surface_class(stream.name));
    return run_steps(source, world, selvage_step);
  }
};

}  // namespace

std::unique_ptr<Property> make_step_campaign() { return std::make_unique<StepCampaign>(); }

}  // namespace selvage::fuzz
