#include "fuzz/step_campaign.h"

#include <algorithm>

#include "fuzz/case_text.h"
#include "fuzz/step_oracle.h"
#include "kernel/assert.h"

namespace selvage::fuzz {
namespace {

const SurfaceClass& surface_of(const Stream& stream) {
  const auto found = std::ranges::find(surface_classes(), stream.name, &SurfaceClass::name);
  SELVAGE_ASSERT(found != surface_classes().end());
  return *found;
}

void append_row(std::string& text, const Positions& x, Eigen::Index row) {
  for (int axis = 0; axis < 3; ++axis) text += " " + hex(x(row, axis));
}

class StepCampaign final : public Property {
 public:
  StepCampaign()
      : Property("step", "no step touches, loses momentum or leaves its script, whatever the candidates (S1 to S4)") {
    weight_ = 2;
    for (const SurfaceClass& surface : surface_classes()) streams_.push_back({std::string(surface.name), 0, 4});
    counters_ = {"steps", "collisions", "zones", "fail-safe", "stopped"};
  }

  Outcome run(const Stream& stream, ChoiceSource source) override {
    const StepObservation seen = observe(stream, source);
    Outcome outcome{{1, seen.defect != StepDefect::kNone, {}, 0}, {}};
    outcome.counts.of = {seen.steps, seen.with_collisions, seen.with_zones, seen.with_fail_safe, seen.stopped};
    if (seen.defect != StepDefect::kNone) outcome.failure = name_of(seen.defect);
    return outcome;
  }

  [[nodiscard]] std::string complaint(const Stream& /*stream*/, const Counts& counts) const override {
    // Measured: half of all steps have collisions, in every class; a tenth says that they have gone.
    return counts.of[0] > 500 && counts.of[1] * 10 < counts.of[0] ? "hardly any collisions" : "";
  }

  std::string kept(const Stream& stream, ChoiceSource source, const std::string& origin, const std::string& failure,
                   bool shrunk) override {
    std::string text = "selvage-step 1 " + stream.name + "\nseed " + origin + "\nfailure " + failure + "\n";
    if (!shrunk) return text;  // the code under test does not survive this case
    ChoiceSource again = source;
    const StepWorld world = make_step_world(again, surface_of(stream));
    const StepObservation seen = run_steps(again, world, selvage_step);
    text += "candidate " + std::string(seen.candidate) + "\n";
    for (const auto& face : world.mesh.faces) {
      text += "f " + std::to_string(face[0]) + " " + std::to_string(face[1]) + " " + std::to_string(face[2]) + "\n";
    }
    for (Eigen::Index row = 0; row < seen.x_t0.rows(); ++row) {  // before, candidate, answer
      text += "v";
      for (const Positions* x : {&seen.x_t0, &seen.x_candidate, &seen.x_t1}) {
        if (row < x->rows()) append_row(text, *x, row);  // a refused step has no answer
      }
      text += "\n";
    }
    return text;
  }

 private:
  static StepObservation observe(const Stream& stream, ChoiceSource& source) {
    const StepWorld world = make_step_world(source, surface_of(stream));
    return run_steps(source, world, selvage_step);
  }
};

}  // namespace

std::unique_ptr<Property> make_step_campaign() { return std::make_unique<StepCampaign>(); }

}  // namespace selvage::fuzz
