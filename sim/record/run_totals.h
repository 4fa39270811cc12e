// What the steps of a run did, summed up: the numbers of run.json.
#pragma once

#include <cstdint>
#include <string>

#include "sim/step.h"

namespace selvage::sim {

/// Strain of springs after a repair that a person is told of: two crossed sheets that were left with it flew apart at
/// 19 m/s (docs/scenes.md), a sheet that a needle went through, left with 6.2, at 40 m/s.
inline constexpr double kTornStrain = 2.5;

/// What `--repair` did to a start that intersected.
struct StartRepair {
  std::int64_t pairs = 0, moved_vertices = 0;
  double largest_move_m = 0;
  double largest_strain = 0;  ///< of springs, as it left them
};

struct RunTotals {
  StartRepair repair;
  std::int64_t frames = 0, steps = 0, halvings = 0;
  std::int64_t proximities = 0, repulsions = 0, frictions = 0;
  std::int64_t steps_with_collisions = 0, first_collisions = 0;
  std::int64_t impulse_rounds = 0, zone_rounds = 0, largest_zone_vertices = 0;
  std::int64_t fail_safe_rounds = 0, fail_safe_vertices = 0;
  std::int64_t pairs_below_tolerance = 0, waiting_bodies = 0, cut_candidates = 0, bent_steps = 0;
  std::int64_t dynamics_solves = 0, newton_rounds = 0, cg_iterations = 0, unconverged_solves = 0;
  double largest_residual_m = 0;  ///< of an implicit solve
  double largest_strain = 0;      ///< of structural and shear springs, at the end of a step
  double largest_strain_at_s = 0;
  std::int64_t largest_strain_from = -1, largest_strain_to = -1;  ///< vertices
  StepPhases phases;
  PhaseTime recording;

  /// Of the steps and of recording them.
  [[nodiscard]] PhaseTime all() const;

  void add(const StepResult& step);
  /// One clause for each thing that went less well than the scene asked for, "" where nothing did: a repair left cloth
  /// torn, the fail-safe was needed, pairs ended a step nearer than the tolerance, bodies waited, vertices were cut
  /// back (travel_limit.h), bodies passed by what lies beside a straight line (StepResult::is_bent), equations were not
  /// solved. No intersection is among them: these end runs.
  [[nodiscard]] std::string shortfalls() const;
};

/// Calls visit(name, field) for every field, in the order above: one list for run.json and for checkpoints.
template <class Totals, class Visit>
void for_each_total(Totals& totals, Visit visit) {
  visit("repaired_pairs", totals.repair.pairs);
  visit("repaired_vertices", totals.repair.moved_vertices);
  visit("largest_repair_m", totals.repair.largest_move_m);
  visit("largest_repair_strain", totals.repair.largest_strain);
  visit("frames", totals.frames);
  visit("steps", totals.steps);
  visit("halvings", totals.halvings);
  visit("proximities", totals.proximities);
  visit("repulsions", totals.repulsions);
  visit("frictions", totals.frictions);
  visit("steps_with_collisions", totals.steps_with_collisions);
  visit("first_collisions", totals.first_collisions);
  visit("impulse_rounds", totals.impulse_rounds);
  visit("zone_rounds", totals.zone_rounds);
  visit("largest_zone_vertices", totals.largest_zone_vertices);
  visit("fail_safe_rounds", totals.fail_safe_rounds);
  visit("fail_safe_vertices", totals.fail_safe_vertices);
  visit("pairs_below_tolerance", totals.pairs_below_tolerance);
  visit("waiting_bodies", totals.waiting_bodies);
  visit("cut_candidates", totals.cut_candidates);
  visit("bent_steps", totals.bent_steps);
  visit("dynamics_solves", totals.dynamics_solves);
  visit("newton_rounds", totals.newton_rounds);
  visit("cg_iterations", totals.cg_iterations);
  visit("unconverged_solves", totals.unconverged_solves);
  visit("largest_residual_m", totals.largest_residual_m);
  visit("largest_strain", totals.largest_strain);
  visit("largest_strain_at_s", totals.largest_strain_at_s);
  visit("largest_strain_from", totals.largest_strain_from);
  visit("largest_strain_to", totals.largest_strain_to);
  const auto visit_phase = [&](const char* name, auto& phase) {
    visit((std::string(name) + "_s").c_str(), phase.wall_s);
    visit((std::string(name) + "_cpu_s").c_str(), phase.cpu_s);
  };
  for_each_phase(totals.phases, visit_phase);
  visit_phase("recording", totals.recording);
}

}  // namespace selvage::sim
