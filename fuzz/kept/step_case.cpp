#include "fuzz/kept/step_case.h"

#include <algorithm>

#include "fuzz/oracle/check_facts.h"

namespace selvage::fuzz {
namespace {

constexpr double kMaxMagnitude =
    0x1p+1000;  ///< of masses and times: their products with a coordinate stay finite, or nearly

using Precision = sim::CollisionOptions::Precision;

StepWorld world_of(const MeshCase& kept) {
  StepWorld world;
  world.x = kept.x[0];
  world.inverse_mass = kept.marks[0];
  for (const double body : kept.marks[1]) world.body.push_back(static_cast<std::int32_t>(body));
  sim::CollisionOptions& options = world.options;
  options.thickness_m = kept.setting("thickness_m");
  options.tolerance_m = kept.setting("tolerance_m");
  options.repulsion = kept.setting("repulsion") != 0;
  options.repulsion_stiffness_n_m = kept.setting("repulsion_stiffness_n_m");
  options.overlap_fraction = kept.setting("overlap_fraction");
  options.relaxation = kept.setting("relaxation");
  options.friction_kinetic = kept.setting("friction_kinetic");
  options.friction_static = kept.setting("friction_static");
  options.max_impulse_rounds = static_cast<std::int32_t>(kept.setting("impulse_iterations"));
  options.max_zone_rounds = static_cast<std::int32_t>(kept.setting("zone_iterations"));
  options.max_intervals = static_cast<std::int32_t>(kept.setting("max_intervals"));
  options.precision = kept.setting("float32") != 0 ? Precision::kFloat32 : Precision::kFloat64;
  world.policy = kept.setting("yield") != 0 ? sim::SqueezePolicy::kYield : sim::SqueezePolicy::kStop;
  world.dt_s = kept.setting("dt_s");
  connect(world, kept.faces);
  return world;
}

/// Why the step promises nothing about this input, by rules written down here once more: what it calls invalid itself
/// is under test.
std::string unfitness(const StepWorld& world, const Positions& candidate) {
  if (world.options.friction_kinetic > world.options.friction_static)
    return "friction_kinetic is above friction_static";
  if (!(world.x.cwiseAbs().maxCoeff() <= kMaxCoordinate)) return "a vertex starts outside the domain";
  if (world.options.precision == Precision::kFloat32 &&
      (world.x.cast<float>().cast<double>().array() != world.x.array()).any()) {
    return "a vertex does not start on the float32 lattice";
  }
  for (Eigen::Index v = 0; v < world.x.rows(); ++v) {
    const bool is_scripted = world.is_scripted(static_cast<std::int32_t>(v));
    if (world.body[static_cast<std::size_t>(v)] >= 0 && !is_scripted) return "a vertex of a body has a mass";
    const auto target = candidate.row(v).cwiseAbs();
    if (is_scripted && (target.array() > kMaxCoordinate).any() && candidate.allFinite()) {
      return "a script leaves the domain";
    }
  }
  return is_clean(world, world.x) ? "" : "the surface intersects itself at the start";
}

Retrial retry_ours(const MeshCase& kept) { return retry_step(kept, selvage_step); }

}  // namespace

const MeshKind& step_kind() {
  static const MeshKind kind{
      "step",
      "no step touches, loses momentum or leaves its script, whatever the candidates (S1 to S4)",
      {"x", "candidate"},
      0,
      {{"thickness_m", 0, 0, kMaxCoordinate},
       {"tolerance_m", 0, 0, kMaxCoordinate},
       {"repulsion", 0, 0, 1, true},
       {"repulsion_stiffness_n_m", 0, 0, kMaxMagnitude},
       {"overlap_fraction", sim::CollisionOptions().overlap_fraction, 0, 1},
       {"relaxation", 1, 0x1p-20, 1},
       {"friction_kinetic", 0, 0, kMaxMagnitude},
       {"friction_static", 0, 0, kMaxMagnitude},
       {"impulse_iterations", 0, 0, 1000, true},
       {"zone_iterations", 0, 0, 1000, true},
       {"max_intervals", static_cast<double>(sim::CollisionOptions().max_intervals), 1, 1 << 24, true},
       {"float32", 0, 0, 1, true},
       {"yield", 0, 0, 1, true},
       {"dt_s", 1, 0x1p-1000, kMaxMagnitude}},
      {{"inverse_mass", 1, 0, kMaxMagnitude}, {"body", -1, -1, 1 << 20, true}},
      retry_ours};
  return kind;
}

MeshCase step_case(const StepWorld& world, const Positions& x_t0, const Positions& candidate) {
  const sim::CollisionOptions& options = world.options;
  MeshCase kept;
  kept.kind = &step_kind();
  kept.settings = {options.thickness_m,
                   options.tolerance_m,
                   options.repulsion ? 1.0 : 0.0,
                   options.repulsion_stiffness_n_m,
                   options.overlap_fraction,
                   options.relaxation,
                   options.friction_kinetic,
                   options.friction_static,
                   static_cast<double>(options.max_impulse_rounds),
                   static_cast<double>(options.max_zone_rounds),
                   static_cast<double>(options.max_intervals),
                   options.precision == Precision::kFloat32 ? 1.0 : 0.0,
                   world.policy == sim::SqueezePolicy::kYield ? 1.0 : 0.0,
                   world.dt_s};
  kept.x = {x_t0, candidate};
  kept.marks = {world.inverse_mass, std::vector<double>(world.body.begin(), world.body.end())};
  kept.faces = world.mesh.faces;
  return kept;
}

Retrial retry_step(const MeshCase& kept, const StepFunction& step) {
  const StepWorld world = world_of(kept);
  Retrial retrial;
  retrial.unfit = unfitness(world, kept.x[1]);
  if (!retrial.unfit.empty()) return retrial;
  const sim::CollisionStepResult result = step(world, kept.x[0], kept.x[1]);
  const sim::CollisionStepReport& report = result.report;
  retrial.facts.push_back("the step is " + std::string(name_of(report.status)) + ": " +
                          std::to_string(report.first_collisions) + " collisions, " +
                          std::to_string(report.impulse_rounds) + " rounds of impulses, " +
                          std::to_string(report.zone_rounds) + " of zones, " +
                          std::to_string(report.fail_safe_vertices) + " vertices held by the fail-safe");
  const StepDefect defect = judge_step(world, kept.x[0], kept.x[1], result);
  if (defect != StepDefect::kNone) retrial.failure = name_of(defect);
  if (report.status == sim::StepStatus::kSafe && result.x.allFinite()) {
    verify::CheckOptions options;
    options.max_violations = kListedFacts;
    append_facts(retrial.facts, "the motion to its answer",
                 verify::check_motion(world.topology, sim::points_of(kept.x[0]), sim::points_of(result.x), options));
  }
  return retrial;
}

}  // namespace selvage::fuzz
