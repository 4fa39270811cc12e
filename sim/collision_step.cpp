#include "sim/collision_step.h"

#include <algorithm>
#include <atomic>
#include <limits>
#include <optional>
#include <utility>

#include "kernel/assert.h"
#include "kernel/fp_env.h"
#include "sim/base/parallel.h"
#include "sim/base/sorted_once.h"
#include "sim/contact/contact_table.h"
#include "sim/contact/start_proximities.h"
#include "sim/contact/straight_surface.h"
#include "sim/contact/surface_parts.h"
#include "sim/response/collision_tracker.h"
#include "sim/response/friction.h"
#include "sim/response/impact_zone.h"
#include "sim/response/impulse.h"
#include "sim/response/repulsion.h"
#include "sim/response/scripted_groups.h"
#include "sim/response/step_limit.h"
#include "sim/response/step_motion.h"
#include "sim/response/travel_limit.h"
#include "sim/step_input.h"

namespace selvage::sim {
namespace {

/// Contacts are looked for where the candidate goes, and again where so many sweeps of its repulsions lead. Ten before
/// and ten behind took 1.7 times the time of two and eight, and the same steps (curtain at full quality, frame 100).
constexpr int kFirstSweeps = 2;

/// What persists between steps. Of the room only the memory: pages that are new to a process take time
/// (docs/measurements/simulator-speed.md).
struct Persistent {
  Persistent(const Mesh& step_mesh, const CollisionOptions& step_options, ContactSurfaces surfaces)
      : mesh(step_mesh),
        options(step_options),
        contacts(step_mesh, step_options, std::move(surfaces)),
        hierarchy(step_mesh),
        parts(step_mesh),
        faces(step_mesh),
        straight(step_mesh, faces),
        proximities(step_mesh, contacts, faces) {}

  const Mesh& mesh;
  CollisionOptions options;
  ContactTable contacts;
  BoxHierarchy hierarchy;
  SurfaceParts parts;
  VertexFaces faces;
  StraightSurfaces straight;
  StartProximities proximities;
  std::vector<RepulsionContact> room_of_found;
  Contacts room_of_swept;
  std::atomic_flag in_use;
};

/// Of what persists, by one call.
class Use {
 public:
  explicit Use(std::atomic_flag& flag) : flag_(flag), is_first_(!flag.test_and_set(std::memory_order_acquire)) {}
  ~Use() {
    if (is_first_) flag_.clear(std::memory_order_release);
  }
  Use(const Use&) = delete;
  Use& operator=(const Use&) = delete;
  [[nodiscard]] bool is_first() const { return is_first_; }

 private:
  std::atomic_flag& flag_;
  const bool is_first_;
};

/// As they stand at the start of a step from V_t0. In room_of_found, which grows as it must.
std::span<const RepulsionContact> make_contacts(const std::vector<PairProximity>& pairs, const Positions& V_t0,
                                                std::span<const double> inverse_mass,
                                                const std::vector<std::uint8_t>& is_cloth, Persistent& step) {
  if (step.room_of_found.size() < pairs.size()) step.room_of_found.resize(pairs.size());
  const std::span<RepulsionContact> contacts = std::span(step.room_of_found).first(pairs.size());
  parallel_each(std::ssize(pairs), [&](Eigen::Index i) {
    const PairProximity& pair = pairs[static_cast<std::size_t>(i)];
    auto made = make_contact(pair, step.contacts.of(pair.kind, pair.first, pair.second), V_t0, inverse_mass);
    if (made) turn_across(step.straight.of(pair.kind, pair.vertices, is_cloth), V_t0, *made);
    contacts[static_cast<std::size_t>(i)] = made.value_or(RepulsionContact{});
  });
  const auto none_was_made = [](const RepulsionContact& contact) { return !(contact.mobility > 0); };
  return {contacts.begin(), std::remove_if(contacts.begin(), contacts.end(), none_was_made)};
}

/// One pass through section 7 with a given set of waiting bodies.
class Attempt {
 public:
  Attempt(Persistent& step, const CollisionBodies& bodies, ScriptedGroups& groups, double dt_s,
          const Patience& patience, std::span<const RepulsionContact> held)
      : step_(step),
        bodies_(bodies),
        groups_(groups),
        dt_s_(dt_s),
        patience_(patience),
        held_(held),
        surface_(step.parts.cloth_flags(bodies)),
        tracker_(step.mesh, step.hierarchy, step.contacts, step.options.max_intervals, surface_),
        update_(step.mesh.vertex_count) {}

  /// The report says how it ended; a conflict where the fail-safe ends in one.
  std::optional<StepLimiter::Conflict> run(const PositionsRef& V_t0, const PositionsRef& V_candidate) {
    const CollisionPhases till_now = report_.phases;
    report_ = {};
    report_.phases = till_now;
    report_.status = StepStatus::kAbandoned;
    met_.clear();
    motion_.start(V_t0, groups_.targets(V_t0, V_candidate), step_.options.precision);
    groups_.observe(motion_);
    report_.cut_candidates = limit_travel(groups_, motion_);
    if (step_.options.repulsion) repel();
    if (!search()) return std::nullopt;
    report_.first_collisions = static_cast<std::int64_t>(tracker_.collisions().size());
    if (step_.options.repulsion) meet_collisions();
    if (report_.first_collisions > patience_.collisions) return std::nullopt;
    const PhaseTimer timer(report_.phases.response);
    apply_impulses();
    if (patience_.impulse_rounds < Patience::kEndless && !tracker_.collisions().empty()) return std::nullopt;
    move_impact_zones();
    auto conflict = hold_back();
    report_.status = conflict ? StepStatus::kStopped : StepStatus::kSafe;
    if (conflict) report_.witness = conflict->collision;
    return conflict;
  }

  /// After run().
  [[nodiscard]] const StepMotion& motion() const { return motion_; }
  [[nodiscard]] CollisionStepReport& report() { return report_; }
  [[nodiscard]] const CollisionTracker& tracker() const { return tracker_; }
  [[nodiscard]] std::vector<RepulsionContact>& met() { return met_; }
  /// Of all runs; unsorted, with repeats.
  [[nodiscard]] std::vector<VertexId>& without_room() { return without_room_; }

 private:
  void repel();
  bool search();
  void meet_collisions();
  void apply_impulses();
  void move_impact_zones();
  std::optional<StepLimiter::Conflict> hold_back();
  void add_without_room(std::span<const VertexId> vertices);
  void add_colliding();
  [[nodiscard]] bool zone_can_help(const Collision& collision) const;

  Persistent& step_;
  const CollisionBodies& bodies_;
  ScriptedGroups& groups_;
  const double dt_s_;
  const Patience patience_;
  const std::span<const RepulsionContact> held_;
  std::vector<RepulsionContact> met_;  ///< beside held_
  std::vector<VertexId> without_room_;
  const std::vector<std::uint8_t> surface_;
  StepMotion motion_;
  CollisionTracker tracker_;
  ParallelUpdate update_;
  CollisionStepReport report_;
};

/// Sections 7.2 and 7.3: the contacts at the start of the step that the candidate presses, then those that these push
/// together. What is beyond the straight part of a body is nearer to another feature, whose contact acts.
void Attempt::repel() {
  {
    const PhaseTimer timer(report_.phases.proximity);
    step_.proximities.start(step_.hierarchy, motion_.V_t0(), surface_);
    step_.straight.start(motion_.V_t0());
    step_.proximities.leave_out(held_);
  }
  Contacts& contacts = step_.room_of_swept;
  contacts.clear();
  const auto add_all = [&](std::span<const RepulsionContact> given) {
    for (const RepulsionContact& contact : given) {
      if (!contact.is_beyond) contacts.add(contact);
    }
  };
  add_all(held_);
  const std::size_t held_count = contacts.size();
  for (const int sweeps : {kFirstSweeps, kRepulsionSweeps - kFirstSweeps}) {
    std::span<const RepulsionContact> found;
    {
      const PhaseTimer timer(report_.phases.proximity);
      found = make_contacts(step_.proximities.find(motion_.x()), motion_.V_t0(), bodies_.inverse_mass, surface_, step_);
    }
    const PhaseTimer timer(report_.phases.repulsion);
    add_all(found);
    contacts.repel(step_.options, dt_s_, sweeps, motion_);
  }
  met_ = contacts.pressed(held_count);
  report_.proximities = std::ssize(held_) + step_.proximities.count();
  report_.repulsions = contacts.count().repulsions;
  report_.frictions = contacts.count().frictions;
}

/// Of all that collides. A motion that meets far too much is cut back first, or given up where its caller has no
/// patience with so much: then false.
bool Attempt::search() {
  const PhaseTimer timer(report_.phases.search);
  const std::size_t most =
      std::max(kMeetingsOfAnyMesh, kMaxMeetings * static_cast<std::size_t>(step_.mesh.vertex_count));
  CollisionLimits limits{.most_collisions = most, .most_near = most};
  if (tracker_.start(motion_, limits)) return true;
  if (tracker_.starts_with_more_near(motion_, most / kMeetingsPerNearAtStart)) {
    limits.most_near = CollisionLimits{}.most_near;
    if (tracker_.start(motion_, limits)) return true;
  }
  for (int cuts = 0; cuts < kMaxCuts; ++cuts) {
    report_.first_collisions = static_cast<std::int64_t>(most) + 1;
    if (patience_.collisions < report_.first_collisions) return false;
    const std::int64_t cut = halve_travel(groups_, motion_, 1 << cuts);
    if (cut == 0) break;  // no cloth moves
    report_.cut_candidates = std::max(report_.cut_candidates, cut);
    if (tracker_.start(motion_, limits)) return true;
  }
  return tracker_.start(motion_);
}

/// What repulsions leave, as contacts: dynamics that know of them do better than impulses at the end of the step.
void Attempt::meet_collisions() {
  for (const Collision& collision : tracker_.collisions()) {
    if (collision.kind == PairKind::kSelf) continue;
    const std::array<VertexId, 4> pair = tracker_.vertices(collision);
    const ContactProperties properties = step_.contacts.of(collision.kind, collision.first, collision.second);
    auto contact = make_contact(collision, pair, properties, motion_.V_t0(), bodies_.inverse_mass);
    if (!contact) continue;
    turn_across(step_.straight.of(collision.kind, pair, surface_), motion_.V_t0(), *contact);
    met_.push_back(*contact);
  }
}

/// Section 7.4: impulses in parallel until nothing collides, for a few rounds.
void Attempt::apply_impulses() {
  const std::int64_t most_rounds = std::min<std::int64_t>(step_.options.max_impulse_rounds, patience_.impulse_rounds);
  while (report_.impulse_rounds < most_rounds && !tracker_.collisions().empty()) {
    ++report_.impulse_rounds;
    std::vector<PairChange> changes;
    for (const Collision& collision : tracker_.collisions()) {
      const std::array<VertexId, 4> pair = tracker_.vertices(collision);
      const Interaction interaction =
          make_interaction(collision.kind, pair, collision.ccd.weights, bodies_.inverse_mass);
      const double tolerance_m = step_.contacts.of(collision.kind, collision.first, collision.second).tolerance_m;
      changes.push_back(collision_impulse(collision, interaction, motion_, tolerance_m));
    }
    update_.apply(changes, step_.options.relaxation, motion_);
    if (!motion_.anything_changed()) return;
    tracker_.update(motion_);
  }
}

/// A rigid zone keeps distances: it stops every collision, and restores the tolerance where there was one at the start.
bool Attempt::zone_can_help(const Collision& collision) const {
  if (collision.ccd.cause != CcdCause::kEnd) return true;
  const std::array<VertexId, 4> v = tracker_.vertices(collision);
  const Positions& V = motion_.V_t0();
  const std::array<Vec3, 4> x{V.row(v[0]), V.row(v[1]), V.row(v[2]), V.row(v[3])};
  const double tolerance = step_.contacts.of(collision.kind, collision.first, collision.second).tolerance_m;
  return pair_proximity(collision.kind, x).distance_lower > tolerance;
}

/// Section 7.5: merge what collides into rigid zones, and grow them until nothing collides.
void Attempt::move_impact_zones() {
  if (tracker_.collisions().empty()) return;
  const Positions displacement = motion_.displacement();  // zones keep the momentum that the impulses left
  ImpactZones zones(step_.mesh.vertex_count, groups_);
  while (report_.zone_rounds < step_.options.max_zone_rounds && !tracker_.collisions().empty()) {
    bool merged = false;
    for (const Collision& collision : tracker_.collisions()) {
      if (zone_can_help(collision)) merged = zones.merge(tracker_.vertices(collision)) || merged;
    }
    if (!merged) break;
    ++report_.zone_rounds;
    zones.move_grown(displacement, bodies_.inverse_mass, motion_);
    tracker_.update(motion_);
  }
  report_.largest_zone = zones.largest();
  for (VertexId v = 0; v < step_.mesh.vertex_count; ++v) {
    const std::vector<VertexId>& zone = zones.members(v);  // of the vertex that it is named for
    if (zone.size() > 1) add_without_room(zone);
  }
}

/// The fail-safe: what still collides is held back, more of it every round.
std::optional<StepLimiter::Conflict> Attempt::hold_back() {
  if (!tracker_.has_motion_collision()) return std::nullopt;
  StepLimiter limiter(step_.mesh, step_.hierarchy, groups_, step_.contacts.thickness_upper());
  while (tracker_.has_motion_collision()) {
    SELVAGE_ASSERT(report_.fail_safe_rounds <= 3 * static_cast<std::int64_t>(step_.mesh.vertex_count));
    ++report_.fail_safe_rounds;
    if (auto conflict = limiter.restrain(tracker_, motion_)) {
      add_colliding();
      add_without_room(limiter.restrained());
      return conflict;
    }
    tracker_.update(motion_);
  }
  const std::vector<VertexId> restrained = limiter.restrained();
  report_.fail_safe_vertices = std::ssize(restrained);
  add_without_room(restrained);
  return std::nullopt;
}

void Attempt::add_without_room(std::span<const VertexId> vertices) {
  for (const VertexId v : vertices) {
    if (!groups_.is_scripted(v)) without_room_.push_back(v);
  }
}

/// What ends nearer than the tolerance is left as it is: nobody waits for it.
void Attempt::add_colliding() {
  for (const Collision& collision : tracker_.collisions()) {
    if (collision.ccd.cause != CcdCause::kEnd) add_without_room(tracker_.vertices(collision));
  }
}

/// displacement / dt, at the largest finite double where that overflows.
Positions average_velocity(const Positions& displacement, double dt_s) {
  static constexpr double kMax = std::numeric_limits<double>::max();
  return displacement.unaryExpr([dt_s](double d) { return std::clamp(d / dt_s, -kMax, kMax); });
}

}  // namespace

std::string_view name_of(StepStatus status) {
  switch (status) {
    case StepStatus::kSafe:
      return "safe";
    case StepStatus::kStopped:
      return "stopped";
    case StepStatus::kAbandoned:
      return "abandoned";
    case StepStatus::kInvalidInput:
      break;
  }
  return "called invalid";
}

struct CollisionStep::Impl : Persistent {
  using Persistent::Persistent;
};

CollisionStep::CollisionStep(const Mesh& mesh, const CollisionOptions& options, ContactSurfaces surfaces)
    : impl_(std::make_unique<Impl>(mesh, options, std::move(surfaces))) {}
CollisionStep::~CollisionStep() = default;
CollisionStep::CollisionStep(CollisionStep&&) noexcept = default;
CollisionStep& CollisionStep::operator=(CollisionStep&&) noexcept = default;

const VertexFaces& CollisionStep::vertex_faces() const {
  SELVAGE_REQUIRE(impl_ != nullptr);
  return impl_->faces;
}

const ContactTable& CollisionStep::contact_table() const {
  SELVAGE_REQUIRE(impl_ != nullptr);
  return impl_->contacts;
}

CollisionStepResult CollisionStep::operator()(const PositionsRef& V_t0, const PositionsRef& V_candidate,
                                              const CollisionBodies& bodies, double dt_s, const Patience& patience,
                                              std::span<const RepulsionContact> held) {
  const FpEnvGuard guard;
  SELVAGE_REQUIRE(impl_ != nullptr);
  CollisionStepResult result{V_t0, Positions::Zero(V_t0.rows(), 3), {}, {}};
  const Use use(impl_->in_use);
  if (!use.is_first()) {
    result.report.input_error = InputError::kInUse;
    return result;
  }
  result.report.input_error = validate_step_input(impl_->mesh, impl_->options, V_t0, V_candidate, bodies, dt_s);
  if (result.report.input_error == InputError::kNone) result.report.input_error = impl_->contacts.error();
  if (result.report.input_error == InputError::kNone) result.report.input_error = validate_held(impl_->mesh, held);
  if (result.report.input_error != InputError::kNone) return result;

  ScriptedGroups groups(bodies);
  Attempt attempt(*impl_, bodies, groups, dt_s, patience, held);
  auto conflict = attempt.run(V_t0, V_candidate);
  while (conflict && bodies.policy == SqueezePolicy::kYield) {
    groups.wait(conflict->groups, conflict->vertices);  // of which one at least moved till now: so this ends
    conflict = attempt.run(V_t0, V_candidate);
  }

  result.report = std::move(attempt.report());
  result.met = std::move(attempt.met());
  result.report.waiting_bodies = groups.waiting_bodies();
  result.report.waiting_vertices = groups.waiting_vertices();
  result.report.without_room = std::move(attempt.without_room());
  keep_sorted_once(result.report.without_room);
  if (result.report.status != StepStatus::kSafe) return result;
  // What is not finite was not certified, whatever the tracker says.
  SELVAGE_ASSERT(attempt.motion().x().allFinite());
  result.report.certificate = attempt.tracker().report();
  result.report.below_tolerance = attempt.tracker().collisions();
  result.report.trusted_pairs = attempt.tracker().trusted(attempt.motion());
  result.x = attempt.motion().x();
  result.velocity = average_velocity(attempt.motion().displacement(), dt_s);
  return result;
}

std::vector<RepulsionContact> CollisionStep::find_contacts(const PositionsRef& V_t0, const PositionsRef& V_candidate,
                                                           const CollisionBodies& bodies, const Vec3& fall,
                                                           const Candidates& pressed) {
  const FpEnvGuard guard;
  SELVAGE_REQUIRE(impl_ != nullptr);
  Impl& impl = *impl_;
  const Use use(impl.in_use);
  if (!use.is_first() || !impl.options.repulsion || impl.contacts.error() != InputError::kNone) return {};
  if (validate_step_input(impl.mesh, impl.options, V_t0, V_candidate, bodies, 1) != InputError::kNone) return {};
  const std::vector<std::uint8_t> surface = impl.parts.cloth_flags(bodies);
  impl.proximities.start(impl.hierarchy, V_t0, surface);
  impl.straight.start(V_t0);
  const std::vector<PairProximity> near = impl.proximities.find(V_candidate, fall, pressed);
  const auto contacts = make_contacts(near, V_t0, bodies.inverse_mass, surface, impl);
  return {contacts.begin(), contacts.end()};
}

}  // namespace selvage::sim
