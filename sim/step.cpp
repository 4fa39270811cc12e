#include "sim/step.h"

#include <algorithm>
#include <set>
#include <tuple>
#include <utility>

#include "kernel/assert.h"
#include "sim/bodies/catch_up.h"
#include "sim/contact_energy.h"
#include "sim/dynamics/central_differences.h"
#include "sim/dynamics/held_contacts.h"
#include "sim/dynamics/implicit_dynamics.h"

namespace selvage::sim {
namespace {

std::unique_ptr<Dynamics> make_dynamics(const Scene& scene, const World& world, double step_s) {
  const StabilizerSystem* stabilizers = world.stabilizers.empty() ? nullptr : &world.stabilizers;
  if (scene.solver == Solver::kImplicit) {
    return std::make_unique<ImplicitDynamics>(
        world.springs,
        ImplicitDynamicsOptions{
            {scene.gravity_m_s2, scene.drag_1_s, scene.quadratic_drag_1_m}, scene.strain, step_s, stabilizers});
  }
  CentralDifferencesOptions options;
  options.gravity_m_s2 = scene.gravity_m_s2;
  options.drag_1_s = scene.drag_1_s;
  options.quadratic_drag_1_m = scene.quadratic_drag_1_m;
  options.strain = scene.strain;
  options.stabilizers = stabilizers;
  options.step_s = step_s;
  options.stable_step_s = world.stable_step_s;
  return std::make_unique<CentralDifferences>(world.springs, options);
}

// The paper halves the step for a single collision, which in folds at speed leaves none much longer than the dynamics'.
// Impulses are good at few: up to one collision for 400 vertices that a few rounds resolve are borne, and an eighth of
// that still counts as a good step, or steps in which something always collides would stay as short as they are.
// docs/simulator-speed.md says what was measured. Small cloth (below 400 vertices) has the paper's rule.
constexpr std::int64_t kVerticesACollision = 400;
constexpr std::int64_t kImpulseRounds = 4;
constexpr std::int64_t kGoodShare = 8;

// Half the step bears twice as much, up to this: what an impulse or a contact moves is less by as much, and to halve
// the step again spares little. At 3 m/s contact overstrains 121 springs in 2.1 ms, and 36 in each half of them
// (sim/scenes/curtain.toml, 2.84 s). docs/simulator-speed.md says what it is worth.
constexpr std::int64_t kMostBorne = 4;

// What a collision step may put into the springs of a part of the cloth, of the energy that this has: otherwise the
// dynamics runs once more, and holds what was met. A step that is long beside the swing of stiff springs displaces
// vertices by more than these would let it. docs/stability.md says what it is worth, and what it costs.
constexpr double kEnergyBorne = 0.08;

// How often the dynamics runs again with the contacts that the collision step met. Two sheets that meet at 12 m/s leave
// 214 collisions, 31, 12; folds of sim/scenes/curtain.toml at full quality in steps of 1/60 s some 1,000, 50, 2.
constexpr int kHoldingRounds = 3;

// Sweeps over the contacts in the last of these runs, at least: where heavy cloth lies on light cloth one sweep leaves
// collisions however short the step is. A carpet of 2 kg/m^2 on three veils of 20 g/m^2, 1.5 s: 102 steps in place of
// 1,005; docs/simulator-speed.md has more.
constexpr std::int32_t kLastSweeps = 4;

bool collided(const CollisionStepReport& report) {
  return report.impulse_rounds + report.zone_rounds + report.fail_safe_rounds > 0;
}

// Where a body had to wait, or zones or the fail-safe had to act, there was no room, and what presses without room
// would be learnt without end: sheets that jammed after they had met at 100 m/s were thrown apart at 10^9 m/s.
bool had_room(const CollisionStepReport& report) {
  return report.waiting_bodies.empty() && report.zone_rounds + report.fail_safe_rounds == 0;
}

bool touched(const CollisionStepReport& report) { return report.repulsions + report.frictions > 0 || collided(report); }

}  // namespace

Simulation::Simulation(const Scene& scene, const FpEnvGuard& /*during*/)
    : scene_(scene),
      world_(build_world(scene_)),
      lengths_(scene_, world_),
      clock_(lengths_.clock()),
      dynamics_(make_dynamics(scene_, world_, lengths_.dynamics_s())),
      collision_step_(world_.mesh, scene_.collision, world_.contacts),
      vertex_faces_(world_.mesh),
      parts_(world_.mesh),
      x_(world_.x_t0),
      v_(world_.v_t0),
      patience_{world_.cloth_vertex_count / kVerticesACollision, kImpulseRounds} {}

StepResult Simulation::step() {
  const FpEnvGuard guard;
  StepResult result;
  const StepClock::State start = clock_.state();
  shortest_s_ = lengths_.shortest_s(0);
  waits_.assign(static_cast<std::size_t>(x_.rows()), 0);
  Try tried = try_step(result);
  while (tried.failed || others_wait(tried)) {
    if (tried.failed) {
      clock_.halve();
      ++result.halvings;
    } else {
      clock_.restore(start);  // who cannot move in the shortest step stands still in the one that was meant
    }
    tried = try_step(result);
  }
  result.dt_s = clock_.dt_s();
  result.end_s = clock_.end_s();
  std::tie(tried.safe.report.waiting_bodies, tried.safe.report.waiting_vertices) = waiting();
  if (tried.safe.report.status == StepStatus::kSafe) {
    const PhaseTimer timer(result.phases.velocity);
    commit(tried.safe, std::move(tried.end));
    result.most_strained = most_strained(world_.springs, x_);
    loads_ = had_room(tried.safe.report) ? std::move(tried.loads) : std::vector<ContactLoad>();
    const bool few = tried.safe.report.first_collisions <= few_collisions();
    const bool is_too_short = 2 * clock_.dt_s() <= shortest_s_;  // for what meets now: it was faster
    clock_.advance((few || is_too_short) && result.dynamics.unconverged == 0);
  }
  result.report = std::move(tried.safe.report);
  result.held_repulsions = tried.held.repulsions;
  result.report.repulsions += tried.held.repulsions;
  result.report.frictions += tried.held.frictions;
  return result;
}

// Bodies that had to wait in a step are known before the next try, which starts from the same state: so the dynamics
// sees them stand still. Where it saw them move, cloth took up a motion that never was: pinched between two spheres
// that stood it came to 70 m/s.
bool Simulation::others_wait(const Try& tried) {
  for (const VertexId v : tried.safe.report.waiting_vertices) waits_[static_cast<std::size_t>(v)] = 1;
  return !tried.safe.report.waiting_vertices.empty();
}

std::pair<std::vector<std::int32_t>, std::vector<VertexId>> Simulation::waiting() const {
  std::set<std::int32_t> bodies;
  std::vector<VertexId> vertices;
  for (VertexId v = 0; v < static_cast<VertexId>(waits_.size()); ++v) {
    if (waits_[static_cast<std::size_t>(v)] == 0) continue;
    bodies.insert(scripted_.body[static_cast<std::size_t>(v)]);
    vertices.push_back(v);
  }
  return {std::vector<std::int32_t>(bodies.begin(), bodies.end()), std::move(vertices)};
}

// The dynamics, with the contacts that it can hold, then the collision step. Where that leaves more collisions than are
// borne, or strains springs, or, the first time, puts energy into them, the dynamics runs again and holds what it met
// as well.
Simulation::Try Simulation::try_step(StepResult& result) {
  Try tried;
  const double dt_s = clock_.dt_s();
  const bool holds = dynamics_->holds_contacts(dt_s, x_.topRows(world_.cloth_vertex_count));
  Positions candidate = scripted_positions();
  std::vector<RepulsionContact> held;
  if (holds) {
    const PhaseTimer timer(result.phases.collision), within(result.phases.within.proximity);
    const Vec3 fall = dt_s * dt_s / 2 * scene_.gravity_m_s2;
    held = collision_step_.find_contacts(x_, in_free_flight(candidate, dt_s), bodies(), fall);
  }
  for (int round = holds ? 0 : kHoldingRounds;; ++round) {
    const bool is_last = round == kHoldingRounds;
    std::vector<RepulsionContact> held_to_the_end;
    {
      const PhaseTimer timer(result.phases.dynamics);
      const HeldSurface surface{world_.mesh,
                                vertex_faces_,
                                collision_step_.contact_table(),
                                scripted_.inverse_mass,
                                world_.cloth_vertex_count,
                                scene_.gravity_m_s2};
      const std::int32_t sweeps = is_last ? std::max(scene_.contact_sweeps, kLastSweeps) : scene_.contact_sweeps;
      HeldContacts contacts(held, loads_, surface, x_, candidate, dt_s, sweeps);
      result.dynamics = advance_cloth(candidate, tried.end, held.empty() ? nullptr : &contacts);
      tried.held = contacts.count();
      tried.loads = contacts.loads();
      held_to_the_end = contacts.contacts();
    }
    tried.failed = can_halve() && (result.dynamics.unconverged > 0 || !candidate.allFinite());
    if (tried.failed) return tried;
    {
      const PhaseTimer timer(result.phases.collision);
      const auto resolve = [&](const Patience& patience) {
        tried.safe = collision_step_(x_, candidate, bodies(), dt_s, patience, held_to_the_end);
        result.phases.within += tried.safe.report.phases;
      };
      // Given up early where a shorter step may be tried. How short it may be, what meets will say.
      const Patience in_last = clock_.can_halve() ? patience_ : Patience{};
      resolve(is_last ? in_last : Patience{borne() * few_collisions(), kImpulseRounds});
      const double fastest_m_s =
          std::max(fastest_contact(held_to_the_end, candidate), fastest_contact(tried.safe.met, candidate));
      shortest_s_ = lengths_.shortest_s(fastest_m_s);
      if (is_last && tried.safe.report.status == StepStatus::kAbandoned && !can_halve()) resolve(Patience{});
    }
    // Cut back by the collision step (travel_limit.h), which a shorter one need not do.
    tried.failed = can_halve() && tried.safe.report.cut_candidates > 0;
    if (tried.failed) return tried;
    tried.failed = tried.safe.report.status == StepStatus::kAbandoned || (can_halve() && overstrains(tried, candidate));
    const bool is_all_held = tried.safe.met.empty();  // another round would do the same
    const bool runs_again = tried.failed || (round == 0 && !is_all_held && energizes(tried));
    if (is_last || !runs_again) return tried;
    if (is_all_held) round = kHoldingRounds - 1;
    held.insert(held.end(), tried.safe.met.begin(), tried.safe.met.end());
  }
}

// The cloth where it is, and scripted vertices where their scripts are at the end of the step, or on their way there:
// first the bodies, then the pins, which may hang on them.
Positions Simulation::scripted_positions() {
  scripted_ = scripted_at(world_, clock_.time_s());
  Positions x = x_;
  for (const Collider& collider : world_.colliders) {
    if (collider.holds(clock_.time_s())) follow_script(collider, x);
  }
  return x;
}

void Simulation::follow_script(const Collider& collider, Positions& x) const {
  const bool float32 = scene_.collision.precision == CollisionOptions::Precision::kFloat32;
  const std::vector<VertexId>& vertices = collider.vertices();
  Positions script_t1 = collider.placed_at(clock_.end_s(), float32, x);
  if (scene_.squeeze == SqueezePolicy::kYield) {  // else none has ever waited
    const Positions now = x_(vertices, Eigen::all), script_t0 = collider.placed_at(clock_.time_s(), float32, x_);
    if (now != script_t0) {
      const double least_speed_m_s = scene_.collision.thickness_m / kCatchUpTime_s;
      const auto follow = collider.deforms() ? catch_up_each : catch_up;
      script_t1 = follow(now, script_t0, script_t1, clock_.dt_s(), least_speed_m_s);
    }
  }
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    if (waits_[static_cast<std::size_t>(vertices[i])] == 0)
      x.row(vertices[i]) = script_t1.row(static_cast<Eigen::Index>(i));
  }
}

// Where a step leads without springs, and twice as deep as cloth falls in it: which contacts are likely to be pressed.
// What lies on other cloth falls with it there, and is not pressed: find_contacts() is told how far one alone falls.
// Running the dynamics for that found no better ones (sim/scenes/curtain.toml at full quality, 2.3 to 2.8 s).
Positions Simulation::in_free_flight(Positions x, double dt_s) const {
  for (Eigen::Index i = 0; i < world_.cloth_vertex_count; ++i) {
    if (scripted_.inverse_mass[static_cast<std::size_t>(i)] == 0) continue;
    x.row(i) += dt_s * (v_.row(i) + dt_s * scene_.gravity_m_s2.transpose());
  }
  return x;
}

DynamicsReport Simulation::advance_cloth(Positions& candidate, Motion& end, HeldContacts* contacts) {
  const Eigen::Index cloth = world_.cloth_vertex_count;
  end.x = x_.topRows(cloth);
  end.v = v_.topRows(cloth);
  const DynamicsReport report =
      dynamics_->advance(end, candidate.topRows(cloth), scripted_.inverse_mass, clock_.dt_s(), contacts);
  candidate.topRows(cloth) = end.x;
  return report;
}

/// How fast, at the start of the step, the points of any of these contacts move against each other; m/s.
double Simulation::fastest_contact(const std::vector<RepulsionContact>& contacts, const Positions& candidate) const {
  double fastest_m_s = 0;
  for (const RepulsionContact& contact : contacts) {
    PairVectors v;
    for (std::size_t i = 0; i < 4; ++i) {
      const VertexId vertex = contact.interaction.vertices[i];
      const bool is_cloth = scripted_.inverse_mass[static_cast<std::size_t>(vertex)] > 0;
      v[i] = v_.row(vertex);
      if (!is_cloth) v[i] = (candidate.row(vertex) - x_.row(vertex)) / clock_.dt_s();
    }
    fastest_m_s = std::max(fastest_m_s, relative(contact.interaction, v).norm());
  }
  return fastest_m_s;
}

std::int64_t Simulation::few_collisions() const { return patience_.collisions / kGoodShare; }

std::int64_t Simulation::borne() const { return std::min(std::int64_t{1} << clock_.halvings(), kMostBorne); }

// Without, a sheet of 16 x 16 vertices that falls on its edge has springs of a sixtieth of their length, and
// sim/scenes/table-legs.toml at full quality springs of 86 times their length.
bool Simulation::overstrains(const Try& tried, const Positions& candidate) const {
  return tried.safe.report.status == StepStatus::kSafe && (touched(tried.safe.report) || tried.held.repulsions > 0) &&
         springs_overstrained(world_.springs, scene_.strain.strain, {x_, candidate, tried.safe.x}) >
             borne() * patience_.collisions;
}

// Under the implicit solver nearly all contacts are held in the first run, and another costs as much as a step.
bool Simulation::energizes(const Try& tried) const {
  if (scene_.solver != Solver::kExplicit || tried.safe.report.status != StepStatus::kSafe) return false;
  const double fall_m_s = clock_.dt_s() * scene_.gravity_m_s2.norm();
  const auto energies =
      contact_energies(world_.springs, parts_, scripted_.inverse_mass, tried.end, tried.safe.x, fall_m_s);
  return std::ranges::any_of(
      energies, [](const ContactEnergy& energy) { return energy.gain_j > kEnergyBorne * energy.before_j; });
}

void Simulation::commit(const CollisionStepResult& safe, Motion end) {
  const Eigen::Index cloth = world_.cloth_vertex_count;
  const double dt_s = clock_.dt_s();
  v_ = (safe.x - x_) / dt_s;
  x_ = safe.x;
  if (touched(safe.report)) {
    end.x = x_.topRows(cloth);
    end.v = safe.velocity.topRows(cloth);
    dynamics_->final_velocity(end, scripted_.inverse_mass, dt_s);
  }
  v_.topRows(cloth) = end.v;
}

void Simulation::restore(const SimulationState& state) {
  SELVAGE_ASSERT(state.x.rows() == x_.rows() && state.v.rows() == v_.rows());
  x_ = state.x;
  v_ = state.v;
  clock_.restore(state.clock);
  loads_ = state.loads;
}

}  // namespace selvage::sim
