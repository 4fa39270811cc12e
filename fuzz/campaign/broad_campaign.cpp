#include "fuzz/campaign/broad_campaign.h"

#include <array>

#include "fuzz/campaign/mesh_property.h"
#include "fuzz/campaign/surface_streams.h"
#include "fuzz/kept/broad_case.h"

namespace selvage::fuzz {
namespace {

class BroadCampaign final : public MeshProperty {
 public:
  BroadCampaign() : MeshProperty("broad", std::string(broad_kind().promise)) {
    streams_ = surface_streams(40);
    counters_ = {"motions", "pairs"};
  }

  Outcome run(const Stream& stream, ChoiceSource source) override {
    const BroadTrial trial = try_broad(drawn(stream, source));
    Outcome outcome{{1, trial.retrial.failure.empty() ? 0 : 1, {}, 0}, trial.retrial.failure};
    outcome.counts.of[kMotions] = 2;
    outcome.counts.of[kPairs] = trial.pairs;
    return outcome;
  }

  [[nodiscard]] std::string complaint(const Stream& /*stream*/, const Counts& counts) const override {
    return counts.cases > 50 && counts.of[kPairs] < counts.cases ? "hardly any pairs" : "";
  }

 private:
  // Places in Counts::of, in the order of counters_.
  enum Counter : std::uint8_t { kMotions, kPairs };

  [[nodiscard]] MeshCase drawn(const Stream& stream, ChoiceSource source) const override {
    const StepWorld world = make_step_world(source, surface_class(stream.name));
    std::array<Positions, 3> x{world.x};
    std::array<BroadQuestion, 2> questions;
    for (std::size_t motion = 0; motion < 2; ++motion) {
      std::string_view candidate_class;
      x[motion + 1] = choose_candidate(source, world, x[motion], candidate_class);
      questions[motion].active = choose_active(source, world);
      questions[motion].reach = choose_length(source, world);
    }
    return broad_case(world.mesh, x, questions);
  }
};

}  // namespace

std::unique_ptr<Property> make_broad_campaign() { return std::make_unique<BroadCampaign>(); }

}  // namespace selvage::fuzz
