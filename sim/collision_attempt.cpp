#include "sim/collision_attempt.h"

#include <algorithm>

#include "kernel/assert.h"
#include "sim/base/parallel.h"
#include "sim/response/impact_zone.h"
#include "sim/response/travel_limit.h"

namespace selvage::sim {
namespace {

/// Contacts are looked for where the candidate goes, and again where so many sweeps of its repulsions lead. Ten before
/// and ten behind took 1.7 times the time of two and eight, and the same steps (curtain at full quality, frame 100).
constexpr int kFirstSweeps = 2;

}  // namespace

std::span<const RepulsionContact> make_contacts(const std::vector<PairProximity>& pairs, const Positions& V_t0,
                                                std::span<const double> inverse_mass,
                                                const std::vector<std::uint8_t>& is_cloth, StepContext& context) {
  if (context.room_of_found.size() < pairs.size()) context.room_of_found.resize(pairs.size());
  const std::span<RepulsionContact> contacts = std::span(context.room_of_found).first(pairs.size());
  parallel_each(std::ssize(pairs), [&](Eigen::Index i) {
    const PairProximity& pair = pairs[static_cast<std::size_t>(i)];
    auto made = make_contact(pair, context.contacts.of(pair.kind, pair.first, pair.second), V_t0, inverse_mass);
    if (made) turn_across(context.straight.of(pair.kind, pair.vertices, is_cloth), V_t0, *made);
    contacts[static_cast<std::size_t>(i)] = made.value_or(RepulsionContact{});
  });
  const auto none_was_made = [](const RepulsionContact& contact) { return !(contact.mobility > 0); };
  return {contacts.begin(), std::remove_if(contacts.begin(), contacts.end(), none_was_made)};
}

CollisionAttempt::CollisionAttempt(StepContext& context, const CollisionBodies& bodies, ScriptedGroups& groups,
                                   double dt_s, const Patience& patience, std::span<const RepulsionContact> held)
    : context_(context),
      bodies_(bodies),
      groups_(groups),
      dt_s_(dt_s),
      patience_(patience),
      held_(held),
      surface_(context.parts.cloth_flags(bodies)),
      tracker_(context.mesh, context.hierarchy, context.contacts, context.options.max_intervals, surface_),
      update_(context.mesh.vertex_count) {}

std::optional<StepLimiter::Conflict> CollisionAttempt::run(const PositionsRef& V_t0, const PositionsRef& V_candidate) {
  const CollisionPhases till_now = report_.phases;
  report_ = {};
  report_.phases = till_now;
  report_.status = StepStatus::kAbandoned;
  met_.clear();
  motion_.start(V_t0, groups_.targets(V_t0, V_candidate), context_.options.precision);
  groups_.observe(motion_);
  report_.cut_candidates = limit_travel(groups_, motion_);
  if (context_.options.repulsion) repel();
  if (!search()) return std::nullopt;
  report_.first_collisions = static_cast<std::int64_t>(tracker_.collisions().size());
  if (context_.options.repulsion) meet_collisions();
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

/// Sections 7.2 and 7.3: the contacts at the start of the step that the candidate presses, then those that these push
/// together. What is beyond the straight part of a body is nearer to another feature, whose contact acts.
void CollisionAttempt::repel() {
  {
    const PhaseTimer timer(report_.phases.proximity);
    context_.proximities.start(context_.hierarchy, motion_.V_t0(), surface_);
    context_.straight.start(motion_.V_t0());
    context_.proximities.leave_out(held_);
  }
  Contacts& contacts = context_.room_of_swept;
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
      found = make_contacts(context_.proximities.find(motion_.x()), motion_.V_t0(), bodies_.inverse_mass, surface_,
                            context_);
    }
    const PhaseTimer timer(report_.phases.repulsion);
    add_all(found);
    contacts.repel(context_.options, dt_s_, sweeps, motion_);
  }
  met_ = contacts.pressed(held_count);
  report_.proximities = std::ssize(held_) + context_.proximities.count();
  report_.repulsions = contacts.count().repulsions;
  report_.frictions = contacts.count().frictions;
}

/// Of all that collides. A motion that meets far too much is cut back first, or given up where its caller has no
/// patience with so much: then false.
bool CollisionAttempt::search() {
  const PhaseTimer timer(report_.phases.search);
  const std::size_t most =
      std::max(kMeetingsOfAnyMesh, kMaxMeetings * static_cast<std::size_t>(context_.mesh.vertex_count));
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
void CollisionAttempt::meet_collisions() {
  for (const Collision& collision : tracker_.collisions()) {
    if (collision.kind == PairKind::kSelf) continue;
    const std::array<VertexId, 4> pair = tracker_.vertices(collision);
    const ContactProperties properties = context_.contacts.of(collision.kind, collision.first, collision.second);
    auto contact = make_contact(collision, pair, properties, motion_.V_t0(), bodies_.inverse_mass);
    if (!contact) continue;
    turn_across(context_.straight.of(collision.kind, pair, surface_), motion_.V_t0(), *contact);
    met_.push_back(*contact);
  }
}

/// Section 7.4: impulses in parallel until nothing collides, for a few rounds.
void CollisionAttempt::apply_impulses() {
  const std::int64_t most_rounds =
      std::min<std::int64_t>(context_.options.max_impulse_rounds, patience_.impulse_rounds);
  while (report_.impulse_rounds < most_rounds && !tracker_.collisions().empty()) {
    ++report_.impulse_rounds;
    std::vector<PairChange> changes;
    for (const Collision& collision : tracker_.collisions()) {
      const std::array<VertexId, 4> pair = tracker_.vertices(collision);
      const Interaction interaction =
          make_interaction(collision.kind, pair, collision.ccd.weights, bodies_.inverse_mass);
      const double tolerance_m = context_.contacts.of(collision.kind, collision.first, collision.second).tolerance_m;
      changes.push_back(collision_impulse(collision, interaction, motion_, tolerance_m));
    }
    update_.apply(changes, context_.options.relaxation, motion_);
    if (!motion_.anything_changed()) return;
    tracker_.update(motion_);
  }
}

/// A rigid zone keeps distances: it stops every collision, and restores the tolerance where there was one at the start.
bool CollisionAttempt::zone_can_help(const Collision& collision) const {
  if (collision.ccd.cause != CcdCause::kEnd) return true;
  const std::array<VertexId, 4> v = tracker_.vertices(collision);
  const Positions& V = motion_.V_t0();
  const std::array<Vec3, 4> x{V.row(v[0]), V.row(v[1]), V.row(v[2]), V.row(v[3])};
  const double tolerance = context_.contacts.of(collision.kind, collision.first, collision.second).tolerance_m;
  return pair_proximity(collision.kind, x).distance_lower > tolerance;
}

/// Section 7.5: merge what collides into rigid zones, and grow them until nothing collides.
void CollisionAttempt::move_impact_zones() {
  if (tracker_.collisions().empty()) return;
  const Positions displacement = motion_.displacement();  // zones keep the momentum that the impulses left
  ImpactZones zones(context_.mesh.vertex_count, groups_);
  while (report_.zone_rounds < context_.options.max_zone_rounds && !tracker_.collisions().empty()) {
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
  for (VertexId v = 0; v < context_.mesh.vertex_count; ++v) {
    const std::vector<VertexId>& zone = zones.members(v);  // of the vertex that it is named for
    if (zone.size() > 1) add_without_room(zone);
  }
}

/// The fail-safe: what still collides is held back, more of it every round.
std::optional<StepLimiter::Conflict> CollisionAttempt::hold_back() {
  if (!tracker_.has_motion_collision()) return std::nullopt;
  StepLimiter limiter(context_.mesh, context_.hierarchy, groups_, context_.contacts.thickness_upper());
  while (tracker_.has_motion_collision()) {
    SELVAGE_ASSERT(report_.fail_safe_rounds <= 3 * static_cast<std::int64_t>(context_.mesh.vertex_count));
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

void CollisionAttempt::add_without_room(std::span<const VertexId> vertices) {
  for (const VertexId v : vertices) {
    if (!groups_.is_scripted(v)) without_room_.push_back(v);
  }
}

/// What ends nearer than the tolerance is left as it is: nobody waits for it.
void CollisionAttempt::add_colliding() {
  for (const Collision& collision : tracker_.collisions()) {
    if (collision.ccd.cause != CcdCause::kEnd) add_without_room(tracker_.vertices(collision));
  }
}

}  // namespace selvage::sim
