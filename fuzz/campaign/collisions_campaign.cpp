#include "fuzz/campaign/collisions_campaign.h"

#include "fuzz/campaign/mesh_property.h"
#include "fuzz/campaign/surface_streams.h"
#include "fuzz/draw/step_world.h"
#include "fuzz/kept/collisions_case.h"

namespace selvage::fuzz {
namespace {

class CollisionsCampaign final : public MeshProperty {
 public:
  CollisionsCampaign() : MeshProperty("collisions", std::string(collisions_kind().promise)) {
    streams_ = surface_streams(40);
    counters_ = {"pairs", "alarms"};
  }

  Outcome run(const Stream& stream, ChoiceSource source) override {
    const CollisionsTrial trial = try_collisions(drawn(stream, source));
    Outcome outcome{{1, trial.retrial.failure.empty() ? 0 : 1, {}, 0}, trial.retrial.failure};
    outcome.counts.of[kPairs] = trial.pairs;
    outcome.counts.of[kAlarms] = trial.alarms;
    return outcome;
  }

  [[nodiscard]] std::string complaint(const Stream& /*stream*/, const Counts& counts) const override {
    return counts.cases > 50 && counts.of[kAlarms] < counts.cases ? "hardly any collisions" : "";
  }

 private:
  // Places in Counts::of, in the order of counters_.
  enum Counter : std::uint8_t { kPairs, kAlarms };

  [[nodiscard]] MeshCase drawn(const Stream& stream, ChoiceSource source) const override {
    const StepWorld world = make_step_world(source, surface_class(stream.name));
    std::string_view candidate_class;
    const Positions x_t1 = choose_candidate(source, world, world.x, candidate_class);
    const double tolerance = choose_length(source, world);
    return collisions_case(world.mesh, world.x, x_t1, tolerance, choose_active(source, world));
  }
};

}  // namespace

std::unique_ptr<Property> make_collisions_campaign() { return std::make_unique<CollisionsCampaign>(); }

}  // namespace selvage::fuzz
