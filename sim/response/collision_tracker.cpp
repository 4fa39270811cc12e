#include "sim/response/collision_tracker.h"

#include <algorithm>
#include <iterator>
#include <tuple>
#include <utility>

namespace selvage::sim {

CollisionTracker::CollisionTracker(const Mesh& mesh, BoxHierarchy& hierarchy, const ContactTable& contacts,
                                   std::int32_t max_intervals, std::vector<std::uint8_t> surface)
    : mesh_(mesh),
      hierarchy_(hierarchy),
      contacts_(contacts),
      max_intervals_(max_intervals),
      surface_(std::move(surface)) {}

std::array<VertexId, 4> CollisionTracker::vertices(const Collision& collision) const {
  return pair_vertices(mesh_, collision.kind, collision.first, collision.second);
}

bool CollisionTracker::has_motion_collision() const {
  return std::ranges::any_of(report_.collisions, [](const Collision& c) { return c.ccd.cause != CcdCause::kEnd; });
}

CollisionReport CollisionTracker::find(const StepMotion& motion, std::span<const std::uint8_t> active,
                                       const CollisionLimits& limits) {
  const CcdOptions options{contacts_.tolerance_upper(), max_intervals_};
  CollisionReport found = find_collisions(mesh_, hierarchy_, motion.V_t0(), motion.x(), options, active, limits);
  if (!contacts_.is_uniform()) hold_to_own_tolerance(motion, found);
  for (Collision& collision : found.collisions) {
    if (moves(collision, motion)) continue;
    collision.ccd.cause = CcdCause::kEnd;
    collision.ccd.toi_lower = 1;
  }
  return found;
}

bool CollisionTracker::moves(const Collision& collision, const StepMotion& motion) const {
  return std::ranges::any_of(vertices(collision), [&](VertexId v) { return motion.moves(v); });
}

std::int64_t CollisionTracker::trusted(const StepMotion& motion) const {
  return std::ranges::count_if(report_.collisions, [&](const Collision& collision) {
    return !moves(collision, motion) && ask(collision, motion, 0).verdict != CcdVerdict::kSeparated;
  });
}

CcdResult CollisionTracker::ask(const Collision& pair, const StepMotion& motion, double tolerance_m) const {
  const std::array<VertexId, 4> v = vertices(pair);
  const auto corners = [&](const Positions& V) {
    return std::array<Vec3, 4>{V.row(v[0]), V.row(v[1]), V.row(v[2]), V.row(v[3])};
  };
  return pair_ccd(pair.kind, corners(motion.V_t0()), corners(motion.x()), {tolerance_m, max_intervals_});
}

void CollisionTracker::hold_to_own_tolerance(const StepMotion& motion, CollisionReport& found) const {
  for (Collision& collision : found.collisions) {
    if (collision.ccd.cause != CcdCause::kEnd) continue;  // a motion is free of touch or not, whatever the tolerance
    const double tolerance_m = contacts_.of(collision.kind, collision.first, collision.second).tolerance_m;
    if (tolerance_m == contacts_.tolerance_upper()) continue;
    collision.ccd = ask(collision, motion, tolerance_m);
    found.intervals += collision.ccd.intervals;
  }
  std::erase_if(found.collisions, [](const Collision& c) { return c.ccd.verdict == CcdVerdict::kSeparated; });
}

void CollisionTracker::count(const CollisionReport& found) {
  report_.vf_candidates += found.vf_candidates;
  report_.ee_candidates += found.ee_candidates;
  report_.self_candidates += found.self_candidates;
  report_.intervals += found.intervals;
  report_.toi_lower = 1;
  for (const Collision& c : report_.collisions) report_.toi_lower = std::min(report_.toi_lower, c.ccd.toi_lower);
}

bool CollisionTracker::starts_with_more_near(const StepMotion& motion, std::size_t most) const {
  const CcdOptions options{contacts_.tolerance_upper(), max_intervals_};
  const CollisionLimits limits{.most_collisions = most, .most_near = most};
  return !find_collisions(mesh_, hierarchy_, motion.V_t0(), motion.V_t0(), options, surface_, limits).is_complete;
}

bool CollisionTracker::start(StepMotion& motion, const CollisionLimits& limits) {
  motion.take_changed();
  CollisionReport found = find(motion, surface_, limits);
  report_ = {};
  if (!found.is_complete) return false;
  report_.collisions = std::move(found.collisions);
  count(found);
  return true;
}

void CollisionTracker::update(StepMotion& motion) {
  if (!motion.anything_changed()) return;
  const std::vector<std::uint8_t> changed = motion.take_changed();
  CollisionReport found = find(motion, changed);
  std::vector<Collision> unchanged;
  for (const Collision& collision : report_.collisions) {
    const auto has_changed = [&](VertexId v) { return changed[static_cast<std::size_t>(v)] != 0; };
    if (std::ranges::none_of(vertices(collision), has_changed)) unchanged.push_back(collision);
  }
  const auto key = [](const Collision& c) { return std::tuple(c.kind, c.first, c.second); };
  report_.collisions.clear();
  std::ranges::merge(unchanged, found.collisions, std::back_inserter(report_.collisions), {}, key, key);
  count(found);
}

}  // namespace selvage::sim
