#include "sim/step.h"

#include <algorithm>
#include <iterator>
#include <tuple>
#include <utility>

#include "kernel/assert.h"
#include "sim/base/sorted_once.h"
#include "sim/contact_energy.h"
#include "sim/dynamics/central_differences.h"
#include "sim/dynamics/held_contacts.h"
#include "sim/dynamics/implicit_dynamics.h"
#include "sim/dynamics/lost_loads.h"

namespace selvage::sim {
namespace {

std::unique_ptr<Dynamics> make_dynamics(const Scene& scene, const World& world, double step_s) {
  const StabilizerSystem* stabilizers = world.stabilizers.empty() ? nullptr : &world.stabilizers;
  const FieldForces fields{scene.gravity_m_s2, scene.drag_1_s, scene.quadratic_drag_1_m};
  if (scene.solver == Solver::kImplicit) {
    return std::make_unique<ImplicitDynamics>(world.springs,
                                              ImplicitDynamicsOptions{fields, scene.strain, step_s, stabilizers});
  }
  return std::make_unique<CentralDifferences>(
      world.springs, CentralDifferencesOptions{fields, scene.strain, step_s, world.stable_step_s, stabilizers});
}

// How often the dynamics runs again with the contacts that the collision step met. Two sheets that meet at 12 m/s leave
// 214 collisions, 31, 12; folds of sim/scenes/curtain.toml at full quality in steps of 1/60 s some 1,000, 50, 2.
constexpr int kHoldingRounds = 3;

// Sweeps over the contacts in the last of these runs, at least: where heavy cloth lies on light cloth one sweep leaves
// collisions however short the step is. A carpet of 2 kg/m^2 on three veils of 20 g/m^2, 1.5 s: 102 steps in place of
// 1,005; docs/measurements/simulator-speed.md has more.
constexpr std::int32_t kLastSweeps = 4;

/// #V: 1 where the collision step has changed the motion of the vertex' part. The dynamics' own velocity holds for the
/// others, whatever it did elsewhere.
std::vector<std::uint8_t> changed_parts(const SurfaceParts& parts, const Positions& x_t0, const Positions& candidate,
                                        const CollisionStepResult& safe, double dt_s) {
  std::vector<std::uint8_t> is_changed(static_cast<std::size_t>(x_t0.rows()));
  for (Eigen::Index i = 0; i < x_t0.rows(); ++i) {
    is_changed[static_cast<std::size_t>(i)] = safe.velocity.row(i) != (candidate.row(i) - x_t0.row(i)) / dt_s;
  }
  return parts.spread(is_changed);
}

}  // namespace

Simulation::Simulation(const Scene& scene, const FpEnvGuard& /*during*/)
    : scene_(scene),
      world_(build_world(scene_)),
      lengths_(scene_, world_),
      clock_(lengths_.clock()),
      dynamics_(make_dynamics(scene_, world_, lengths_.dynamics_s())),
      collision_step_(world_.mesh, scene_.collision, world_.contacts),
      parts_(world_.mesh),
      allowance_(scene_, world_, parts_),
      script_(scene_, world_),
      x_(world_.x_t0),
      v_(world_.v_t0) {}

StepResult Simulation::step() {
  const FpEnvGuard guard;
  StepResult result;
  result.is_bent = !shorten_for_scripts();
  shortest_s_ = lengths_.shortest_s(0);
  script_.start_step(clock_.time_s());
  Try tried = find_good_try(result);
  result.dt_s = clock_.dt_s();
  result.end_s = clock_.end_s();
  if (tried.safe.report.status == StepStatus::kSafe) {
    const PhaseTimer timer(result.phases.velocity);
    commit(tried);
    result.most_strained = most_strained(world_.springs, x_);
    // What meets has slowed down since it asked for so short a step.
    const bool is_too_short = 2 * clock_.dt_s() <= shortest_s_;
    clock_.advance((allowance_.is_good(tried.safe.report) || is_too_short) && result.dynamics.unconverged == 0);
  }
  result.report = std::move(tried.safe.report);
  result.held_repulsions = tried.held.repulsions;
  result.report.repulsions += tried.held.repulsions;
  result.report.frictions += tried.held.frictions;
  return result;
}

// Before any try: no response of a try tells of cloth that a body has passed beside its straight way.
bool Simulation::shorten_for_scripts() {
  auto way = script_.way(x_, v_, clock_);
  while (way != ScriptedMotion::Way::kAsSeen && clock_.can_halve()) {
    clock_.shorten();
    way = script_.way(x_, v_, clock_);
  }
  return way != ScriptedMotion::Way::kBent;
}

// With half the step where a try failed. With those led along what blocks them that had to wait, or at rest where that
// did not help (ScriptedMotion::wait()); then in the step that was meant, since who cannot move as his script says in
// the shortest step does not in that.
Simulation::Try Simulation::find_good_try(StepResult& result) {
  const StepClock::State meant = clock_.state();
  std::vector<VertexId> without_room;  // before bodies waited
  for (;;) {
    Try tried = try_step(result);
    CollisionStepReport& report = tried.safe.report;
    if (tried.failed) {
      clock_.halve();
      ++result.halvings;
    } else if (!report.waiting_vertices.empty()) {
      std::ranges::copy(report.without_room, std::back_inserter(without_room));
      script_.wait(report);
      clock_.restore(meant);
    } else {
      std::tie(report.waiting_bodies, report.waiting_vertices) = script_.waiting();
      std::ranges::copy(without_room, std::back_inserter(report.without_room));
      keep_sorted_once(report.without_room);
      return tried;
    }
  }
}

// The dynamics, with the contacts that it can hold, then the collision step. Where that leaves more collisions than are
// borne, or strains springs, or puts energy into them, the dynamics runs again and holds what it met as well.
Simulation::Try Simulation::try_step(StepResult& result) {
  Try tried;
  tried.candidate = script_.follow(x_, clock_);
  const bool holds = dynamics_->holds_contacts(clock_.dt_s(), x_.topRows(world_.cloth_vertex_count));
  std::vector<RepulsionContact> held;
  if (holds) held = likely_contacts(tried.candidate, result.phases);
  for (int round = holds ? 0 : kHoldingRounds;; ++round) {
    const bool is_last = round == kHoldingRounds;
    const std::vector<RepulsionContact>& held_to_the_end = run_dynamics(held, is_last, tried, result);
    tried.failed = can_halve() && result.dynamics.unconverged > 0;
    if (tried.failed) return tried;
    resolve_collisions(held_to_the_end, is_last, tried, result.phases);
    // Cut back by the collision step (travel_limit.h), which a shorter one need not do.
    tried.failed = can_halve() && tried.safe.report.cut_candidates > 0;
    if (tried.failed) return tried;
    const Verdict verdict = judge(held_to_the_end, round == 0, tried);
    tried.failed = verdict == Verdict::kFailed;
    if (is_last || verdict == Verdict::kGood) return tried;
    if (tried.safe.met.empty()) round = kHoldingRounds - 1;  // all is held: what is left to try is the last round
    held.insert(held.end(), tried.safe.met.begin(), tried.safe.met.end());
  }
}

Simulation::Verdict Simulation::judge(const std::vector<RepulsionContact>& held, bool is_first,
                                      const Try& tried) const {
  if (tried.safe.report.status == StepStatus::kAbandoned) return Verdict::kFailed;
  if (can_halve() && overstrains(tried)) return Verdict::kFailed;
  const bool is_new = is_first && !tried.safe.met.empty();  // the first time that more was met than was held
  if (!is_new && !can_halve()) return Verdict::kGood;
  if (!energizes(held, is_new, tried)) return Verdict::kGood;
  return is_new ? Verdict::kHoldMore : Verdict::kFailed;
}

// The contacts that free flight, without springs, would press. Gravity moves the candidate by g dt^2, twice the fall,
// so that pairs which hardly touch are among them. What lies on other cloth falls with it there, and is not pressed:
// find_contacts() is told how far one alone falls. Running the dynamics for that found no better ones
// (sim/scenes/curtain.toml at full quality, 2.3 to 2.8 s). And those that pressed in the last step, in the dynamics or
// behind it, whatever pressed them: what springs press, such as the hem of draped cloth, was pulled in by the dynamics
// and thrown out by the collision step, in every step or in every other one, and moved for ever
// (docs/measurements/simulator-speed.md, *What pressed is held*).
std::vector<RepulsionContact> Simulation::likely_contacts(Positions x, StepPhases& phases) {
  const PhaseTimer timer(phases.collision), within(phases.within.proximity);
  const double dt_s = clock_.dt_s();
  for (Eigen::Index i = 0; i < world_.cloth_vertex_count; ++i) {
    if (script_.is_scripted(static_cast<VertexId>(i))) continue;
    x.row(i) += dt_s * (v_.row(i) + dt_s * scene_.gravity_m_s2.transpose());
  }
  return collision_step_.find_contacts(x_, x, script_.bodies(), dt_s * dt_s / 2 * scene_.gravity_m_s2, pressed_);
}

const std::vector<RepulsionContact>& Simulation::run_dynamics(const std::vector<RepulsionContact>& held, bool is_last,
                                                              Try& tried, StepResult& result) {
  const PhaseTimer timer(result.phases.dynamics);
  const Eigen::Index cloth = world_.cloth_vertex_count;
  const HeldSurface surface{world_.mesh,
                            parts_,
                            collision_step_.vertex_faces(),
                            collision_step_.contact_table(),
                            script_.inverse_mass(),
                            world_.cloth_vertex_count,
                            scene_.gravity_m_s2,
                            script_.bow_m()};
  const std::int32_t sweeps = is_last ? std::max(scene_.contact_sweeps, kLastSweeps) : scene_.contact_sweeps;
  held_to_the_end_ = held;
  HeldContacts contacts(std::move(held_to_the_end_), loads_, surface, x_, tried.candidate, clock_.dt_s(), sweeps);
  tried.end = {x_.topRows(cloth), v_.topRows(cloth)};
  result.dynamics = dynamics_->advance(tried.end, tried.candidate.topRows(cloth), script_.inverse_mass(), clock_.dt_s(),
                                       held.empty() ? nullptr : &contacts);
  tried.candidate.topRows(cloth) = tried.end.x;
  tried.held = contacts.count();
  tried.loads = contacts.loads();
  tried.pressed = contacts.repelled_pairs();
  held_to_the_end_ = std::move(contacts).take_contacts();
  return held_to_the_end_;
}

// Stops early where a shorter step may be tried. How short that may be, the fastest of the contacts found here says.
void Simulation::resolve_collisions(const std::vector<RepulsionContact>& held, bool is_last, Try& tried,
                                    StepPhases& phases) {
  const PhaseTimer timer(phases.collision);
  const auto resolve = [&](const Patience& patience) {
    tried.safe = collision_step_(x_, tried.candidate, script_.bodies(), clock_.dt_s(), patience, held);
    phases.within += tried.safe.report.phases;
  };
  const Patience in_last = clock_.can_halve() ? allowance_.patience() : Patience{};
  resolve(is_last ? in_last : allowance_.patience_before_last(clock_.halvings()));
  shortest_s_ = lengths_.shortest_s(
      std::max(fastest_contact(held, tried.candidate), fastest_contact(tried.safe.met, tried.candidate)));
  if (is_last && tried.safe.report.status == StepStatus::kAbandoned && !can_halve()) resolve(Patience{});
}

// By velocities at the start of the step; scripted vertices by their mean over it.
double Simulation::fastest_contact(const std::vector<RepulsionContact>& contacts, const Positions& candidate) const {
  double fastest_m_s = 0;
  for (const RepulsionContact& contact : contacts) {
    PairVectors v;
    for (std::size_t i = 0; i < 4; ++i) {
      const VertexId vertex = contact.interaction.vertices[i];
      v[i] = v_.row(vertex);
      if (script_.is_scripted(vertex)) v[i] = (candidate.row(vertex) - x_.row(vertex)) / clock_.dt_s();
    }
    fastest_m_s = std::max(fastest_m_s, relative(contact.interaction, v).norm());
  }
  return fastest_m_s;
}

bool Simulation::overstrains(const Try& tried) const {
  const CollisionStepReport& report = tried.safe.report;
  return report.status == StepStatus::kSafe && (report.touched() || tried.held.repulsions > 0) &&
         allowance_.overstrains(x_, tried.candidate, tried.safe.x, clock_.halvings());
}

bool Simulation::energizes(const std::vector<RepulsionContact>& held, bool is_new, const Try& tried) const {
  const CollisionStepReport& report = tried.safe.report;
  if (report.status != StepStatus::kSafe || !report.touched()) return false;
  // Rounded as the collision step rounds: where coordinates are large that puts energy into stiff springs by itself.
  const Positions x = to_lattice(tried.candidate, scene_.collision.precision);
  Positions v = (tried.candidate - x_) / clock_.dt_s();
  for (Eigen::Index i = 0; i < world_.cloth_vertex_count; ++i) {
    if (!script_.is_scripted(static_cast<VertexId>(i))) v.row(i) = tried.end.v.row(i);
  }
  const ResolvedStep step{x, tried.safe.x, v, held, tried.safe.met};
  return allowance_.energizes(step, script_.inverse_mass(), clock_.dt_s(), is_new);
}

// Section 5: "If there were no repulsions or collisions" the velocity is that of the dynamics, "otherwise" it comes
// from the midstep velocity (7.6), in those parts of the cloth that the collision step has changed.
void Simulation::commit(Try& tried) {
  const Eigen::Index cloth = world_.cloth_vertex_count;
  const CollisionStepResult& safe = tried.safe;
  const double dt_s = clock_.dt_s();
  const std::vector<std::uint8_t> is_changed = changed_parts(parts_, x_, tried.candidate, safe, dt_s);
  v_ = (safe.x - x_) / dt_s;
  x_ = safe.x;
  v_.topRows(cloth) = tried.end.v;
  if (safe.report.touched()) {
    Motion end = {x_.topRows(cloth), safe.velocity.topRows(cloth)};
    dynamics_->final_velocity(end, script_.inverse_mass(), dt_s);
    for (Eigen::Index i = 0; i < cloth; ++i) {
      if (is_changed[static_cast<std::size_t>(i)] != 0) v_.row(i) = end.v.row(i);
    }
  }
  script_.end_step(dt_s);
  pressed_ = std::move(tried.pressed);
  for (const RepulsionContact& contact : safe.met) add_pair(contact, pressed_);
  sort_pairs(pressed_);
  loads_ = std::move(tried.loads);
  forget_loads(safe.report.without_room, pressed_, world_.mesh, parts_, static_cast<VertexId>(cloth), loads_);
}

void Simulation::restore(const SimulationState& state) {
  SELVAGE_ASSERT(state.x.rows() == x_.rows() && state.v.rows() == v_.rows());
  x_ = state.x;
  v_ = state.v;
  clock_.restore(state.clock);
  loads_ = state.loads;
  pressed_ = state.pressed;
  script_.restore(state.blocked);
}

}  // namespace selvage::sim
