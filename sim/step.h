// One time step of a scene, as section 5 of the paper lists it: a step size (step_clock.h), a candidate from the
// dynamics (run_dynamics()), repulsions and collisions (resolve_collisions(): sections 7.2 to 7.5, in the order in
// which collision_attempt.cpp has them), velocities (commit()); tried again with half the step where that is asked
// (find_good_try()).
#pragma once

#include <memory>
#include <vector>

#include "kernel/candidates.h"
#include "kernel/fp_env.h"
#include "sim/base/phase_times.h"
#include "sim/collision_step.h"
#include "sim/contact/repulsion_contact.h"
#include "sim/contact/surface_parts.h"
#include "sim/dynamics/contact_load.h"
#include "sim/dynamics/dynamics.h"
#include "sim/scene/scene.h"
#include "sim/scripted_motion.h"
#include "sim/springs/spring_strain.h"
#include "sim/step_allowance.h"
#include "sim/step_clock.h"
#include "sim/step_lengths.h"
#include "sim/world.h"

namespace selvage::sim {

/// Everything that changes while a scene runs: what a checkpoint holds.
struct SimulationState {
  Positions x, v;  ///< #V by 3, m and m/s
  StepClock::State clock;
  ContactLoads loads;  ///< at x
  Candidates pressed;  ///< the pairs that pressed in the last step
  std::vector<BlockedWay> blocked;
};

struct StepResult {
  /// Of the step that was taken, or that could not be. Its contacts are those that the dynamics held, too.
  CollisionStepReport report;
  std::int64_t held_repulsions = 0;  ///< of its repulsions, those within the dynamics
  DynamicsReport dynamics;           ///< of the step that was taken
  double dt_s = 0, end_s = 0;
  bool is_bent = false;    ///< some body did not go straight, though the step was as short as it may be
  Strained most_strained;  ///< of structural and shear springs, at the end of the step
  /// Tries thrown away because repulsions were not enough, contact overstrained springs or put too much energy into
  /// them, the equations of implicit dynamics were not solved, or candidates were cut back.
  std::int32_t halvings = 0;
  StepPhases phases;  ///< those tries included
};

class Simulation {
 public:
  /// Builds what the scene asks for. Throws io::Error. The guard lives while the members are made, as no body of a
  /// constructor could see to.
  explicit Simulation(const Scene& scene) : Simulation(scene, FpEnvGuard()) {}
  /// Its parts refer to each other.
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;

  /// Advances to the end of one collision step. PRE: the state is free of intersections (build_world does not check it;
  /// the command does). Where report.status is not kSafe, nothing was advanced.
  StepResult step();

  [[nodiscard]] const Scene& scene() const { return scene_; }
  [[nodiscard]] const World& world() const { return world_; }
  [[nodiscard]] const Positions& x() const { return x_; }
  [[nodiscard]] const StepClock& clock() const { return clock_; }
  [[nodiscard]] SimulationState state() const {
    return {x_, v_, clock_.state(), loads_, pressed_, script_.blocked_ways()};
  }
  void restore(const SimulationState& state);

 private:
  Simulation(const Scene& scene, const FpEnvGuard& during);

  struct Try {
    bool failed = false;  ///< to be tried with half the step
    Positions candidate;  ///< #V by 3: of the dynamics and the scripts
    Motion end;           ///< of the dynamics
    RepulsionCount held;  ///< in the dynamics
    ContactLoads loads;   ///< at its end
    Candidates pressed;   ///< in it
    CollisionStepResult safe;
  };
  /// Whether a step is short enough then for bodies that turn.
  bool shorten_for_scripts();
  /// The first try that has not failed and in which nothing has to wait any more; in the clock's step then.
  Try find_good_try(StepResult& result);
  /// From the state, in the clock's step; adds its phases, and the dynamics' report.
  Try try_step(StepResult& result);
  enum class Verdict {
    kGood,      ///< or nothing better can be had
    kHoldMore,  ///< the dynamics should hold what was met as well
    kFailed     ///< that, and half the step where it does not help
  };
  /// `held`: in the dynamics, to its end.
  [[nodiscard]] Verdict judge(const std::vector<RepulsionContact>& held, bool is_first, const Try& tried) const;
  /// Contacts that the dynamics should hold from the beginning. `x`: scripted vertices at the end of the step.
  [[nodiscard]] std::vector<RepulsionContact> likely_contacts(Positions x, StepPhases& phases);
  /// From the state to the try's candidate. Gives back the contacts as they were held to the end.
  const std::vector<RepulsionContact>& run_dynamics(const std::vector<RepulsionContact>& held, bool is_last, Try& tried,
                                                    StepResult& result);
  /// From the state and the try's candidate to positions that are safe.
  void resolve_collisions(const std::vector<RepulsionContact>& held, bool is_last, Try& tried, StepPhases& phases);
  [[nodiscard]] bool can_halve() const { return clock_.can_halve(shortest_s_); }
  /// How fast the points of any of these contacts move against each other; m/s.
  [[nodiscard]] double fastest_contact(const std::vector<RepulsionContact>& contacts, const Positions& candidate) const;
  /// Whether contact presses more springs than are borne.
  [[nodiscard]] bool overstrains(const Try& tried) const;
  /// Whether the collision step put more energy into the springs of a part than is borne.
  [[nodiscard]] bool energizes(const std::vector<RepulsionContact>& held, bool is_new, const Try& tried) const;
  void commit(Try& tried);

  Scene scene_;
  World world_;
  StepLengths lengths_;
  StepClock clock_;
  double shortest_s_ = 0;  ///< for what meets in this step
  std::unique_ptr<Dynamics> dynamics_;
  CollisionStep collision_step_;
  SurfaceParts parts_;
  StepAllowance allowance_;
  ScriptedMotion script_;
  Positions x_, v_;
  ContactLoads loads_;
  Candidates pressed_;
  std::vector<RepulsionContact> held_to_the_end_;  ///< by the last run of the dynamics; memory that stays
};

}  // namespace selvage::sim
