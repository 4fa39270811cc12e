// The collision step and its responses (S1 to S4), and that threads change nothing (K7).
#include <oneapi/tbb/task_arena.h>

#include "fuzz/oracle/step_oracle.h"
#include "sim/response/impact_zone.h"
#include "tests/mutants/drawn_property.h"
#include "tests/mutants/properties.h"
#include "tests/sim/response/response_properties.h"

namespace selvage::mutants {
namespace {

fuzz::StepObservation observe(std::uint64_t seed) {
  fuzz::ChoiceSource source = fuzz::ChoiceSource::from_seed(seed);
  return fuzz::run_steps(source, fuzz::selvage_step);
}

std::string judge_steps(std::uint64_t seed) {
  const fuzz::StepObservation seen = observe(seed);
  if (seen.defect == fuzz::StepDefect::kNone) return "";
  return std::string(name_of(seen.defect)) + ", " + std::string(seen.surface) + ", " + std::string(seen.candidate);
}

std::string compare_step_threads(std::uint64_t seed) {
  const auto observe_with = [seed](int threads) {
    return oneapi::tbb::task_arena(threads).execute([seed] { return observe(seed); });
  };
  const fuzz::StepObservation one = observe_with(1), many = observe_with(7);
  return one.steps == many.steps && one.x_t1 == many.x_t1 ? "" : "other bits";
}

/// Merges random pairs of vertices, and compares the zones with the components of the graph of the pairs.
std::string judge_zones(std::uint64_t seed) {
  constexpr VertexId kCount = 12;
  fuzz::ChoiceSource source = fuzz::ChoiceSource::from_seed(seed);
  const std::vector<double> inverse_mass(kCount, 1.0);
  const sim::ScriptedGroups groups(sim::CollisionBodies{inverse_mass, {}, sim::SqueezePolicy::kStop});
  sim::ImpactZones zones(kCount, groups);
  std::vector<VertexId> component(kCount);
  for (VertexId v = 0; v < kCount; ++v) component[static_cast<std::size_t>(v)] = v;
  for (int merges = source.range(1, 8); merges > 0; --merges) {
    std::array<VertexId, 4> pair;
    for (VertexId& v : pair) v = source.range(0, kCount - 1);
    (void)zones.merge(pair);
    for (const VertexId v : pair) {
      const VertexId from = component[static_cast<std::size_t>(v)], to = component[static_cast<std::size_t>(pair[0])];
      for (VertexId& c : component) c = c == from ? to : c;
    }
  }
  for (VertexId v = 0; v < kCount; ++v) {
    for (VertexId w = 0; w < v; ++w) {
      const bool one = component[static_cast<std::size_t>(v)] == component[static_cast<std::size_t>(w)];
      if (one != (zones.zone(v) == zones.zone(w)))
        return one ? "a zone is in two parts" : "zones are joined for nothing";
    }
    if (std::ranges::count(zones.members(zones.zone(v)), v) != 1) return "a zone does not list its vertex";
  }
  return "";
}

std::optional<Kill> falsify_impulse(std::uint64_t seed, long limit) {
  return first_drawn_failure(seed, limit, sim::testbed::prop_impulse_does_what_is_asked);
}
std::optional<Kill> falsify_repulsion(std::uint64_t seed, long limit) {
  return first_drawn_failure(seed, limit, sim::testbed::prop_repulsion_ends_the_approach);
}
std::optional<Kill> falsify_friction(std::uint64_t seed, long limit) {
  return first_drawn_failure(seed, limit, sim::testbed::prop_friction_keeps_momenta_and_the_cone);
}
std::optional<Kill> falsify_zone_motion(std::uint64_t seed, long limit) {
  return first_drawn_failure(seed, limit, [] {
    const auto shape = *rc::gen::element(sim::testbed::ZoneShape::kSpread, sim::testbed::ZoneShape::kLine);
    sim::testbed::prop_zone_keeps_distances_and_momentum(shape);
    sim::testbed::prop_zone_keeps_angular_momentum(shape);
  });
}

}  // namespace

std::vector<Property> step_properties() {
  return {
      {"step", "a collision step keeps S1 to S4, by the exact checker and by balances", falsify<judge_steps>},
      {"step-threads", "a collision step gives the same bits for 1 and for 7 threads (K7)",
       falsify<compare_step_threads>, true},
      {"zones", "impact zones are the components of what was merged (S3)", falsify<judge_zones>},
      {"impulse", "an impulse changes the relative motion as asked and keeps momentum (S3)", falsify_impulse},
      {"repulsion", "a pair within the thickness stops approaching, and is pushed no farther than it may be (S3)",
       falsify_repulsion},
      {"friction", "friction keeps both momenta, adds no energy and stays in Coulomb's cone (S3)", falsify_friction},
      {"zone-motion", "a zone keeps its distances and both momenta and adds no energy (S3)", falsify_zone_motion}};
}

}  // namespace selvage::mutants
