#include "fuzz/broad_campaign.h"

#include <algorithm>
#include <cmath>

#include "fuzz/step_world.h"
#include "kernel/assert.h"
#include "kernel/box_hierarchy.h"

namespace selvage::fuzz {
namespace {

double choose_reach(ChoiceSource& source, const StepWorld& world) {
  return source.coin() ? std::ldexp(world.gap_m, source.range(-20, 3)) : 0;
}

/// All vertices, or some.
std::vector<std::uint8_t> choose_active(ChoiceSource& source, const StepWorld& world) {
  std::vector<std::uint8_t> active;
  if (!source.coin()) return active;
  for (Eigen::Index i = 0; i < world.x.rows(); ++i) active.push_back(source.n(4) == 1 ? 1 : 0);
  return active;
}

class BroadCampaign final : public Property {
 public:
  BroadCampaign() : Property("broad", "every hierarchy finds exactly the pairs that brute force finds (K6)") {
    for (const SurfaceClass& surface : surface_classes()) streams_.push_back({std::string(surface.name), 0, 40});
    counters_ = {"motions", "pairs"};
  }

  Outcome run(const Stream& stream, ChoiceSource source) override {
    const auto surface = std::ranges::find(surface_classes(), stream.name, &SurfaceClass::name);
    SELVAGE_ASSERT(surface != surface_classes().end());
    const StepWorld world = make_step_world(source, *surface);
    Outcome outcome{{1, 0, {}, 0}, {}};
    std::vector<BoxHierarchy> hierarchies;
    for (const auto kind : {HierarchyKind::kAutomatic, HierarchyKind::kSpatial, HierarchyKind::kTopology}) {
      hierarchies.emplace_back(world.mesh, kind);
    }
    Positions x_t0 = world.x;
    for (int motion = 0; motion < 2; ++motion) {  // the second refits what the first made
      std::string_view candidate_class;
      const Positions x_t1 = choose_candidate(source, world, x_t0, candidate_class);
      const std::vector<std::uint8_t> active = choose_active(source, world);
      const CandidateOptions options{.reach = choose_reach(source, world), .active = active};
      const Candidates all = find_candidates_brute_force(world.mesh, x_t0, x_t1, options);
      ++outcome.counts.of[0];
      outcome.counts.of[1] += static_cast<std::int64_t>(all.vf.size() + all.ee.size());
      for (BoxHierarchy& hierarchy : hierarchies) {
        hierarchy.refit(x_t0, x_t1, options);
        if (hierarchy.candidates() != all) outcome.failure = "not-brute-force";
      }
      x_t0 = x_t1;
    }
    outcome.counts.failures = outcome.failure.empty() ? 0 : 1;
    return outcome;
  }

  [[nodiscard]] std::string complaint(const Stream& /*stream*/, const Counts& counts) const override {
    return counts.cases > 50 && counts.of[1] < counts.cases ? "hardly any pairs" : "";
  }

  std::string kept(const Stream& stream, ChoiceSource /*source*/, const std::string& origin, const std::string& failure,
                   bool /*shrunk*/) override {
    return "selvage-broad 1 " + stream.name + "\nseed " + origin + "\nfailure " + failure + "\n";
  }
};

}  // namespace

std::unique_ptr<Property> make_broad_campaign() { return std::make_unique<BroadCampaign>(); }

}  // namespace selvage::fuzz
