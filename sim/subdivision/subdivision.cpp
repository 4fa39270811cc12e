#include "sim/subdivision/subdivision.h"

#include <algorithm>
#include <stdexcept>

#include "kernel/fp_env.h"
#include "sim/response/collision_tracker.h"

namespace selvage::sim {
namespace {

/// Of the way to the proved earliest touch: "just before that point to avoid difficulties with rounding error".
constexpr double kStopShare = 0.9;
/// Vertices that would go less than this share of their way stay on the surface: so each stops at most
/// log(kLeastShare) / log(kStopShare) = 44 times, and the search ends after 44 #V rounds. Measured: 1 to 6.
constexpr double kLeastShare = 0.01;

/// Shortens the motion of every vertex of a collision, by what its earliest one leaves.
void stop_before_touch(const CollisionTracker& tracker, std::vector<double>& share, StepMotion& motion,
                       const Positions& way) {
  std::vector<double> next = share;
  for (const Collision& collision : tracker.collisions()) {
    if (collision.ccd.cause == CcdCause::kEnd) continue;
    for (const VertexId vertex : tracker.vertices(collision)) {
      const auto v = static_cast<std::size_t>(vertex);
      const double stop = kStopShare * collision.ccd.toi_lower * share[v];
      next[v] = std::min(next[v], stop < kLeastShare ? 0 : stop);
    }
  }
  for (std::size_t v = 0; v < share.size(); ++v) {
    if (next[v] == share[v]) continue;
    const auto vertex = static_cast<VertexId>(v);
    if (next[v] == 0) {
      motion.freeze(vertex);
    } else {
      motion.move(vertex, next[v] * way.row(vertex).transpose());
    }
  }
  share = std::move(next);
}

}  // namespace

struct Subdivision::Level {
  Level(const Mesh& coarse, const std::vector<std::uint8_t>& rigid)
      : rules(coarse, rigid),
        mesh(make_mesh(coarse.vertex_count + static_cast<std::int32_t>(coarse.edges.size()), rules.triangles())) {}

  LoopRules rules;
  Mesh mesh;
};

bool may_subdivide(std::size_t face_count, std::int32_t levels) {
  constexpr std::int32_t kNoneIsLeft = 16;  // of an int32 after so many divisions by four
  return face_count <= static_cast<std::size_t>(kMaxFaceCount) >> (2 * std::min(levels, kNoneIsLeft));
}

Subdivision::Subdivision(const io::Triangles& triangles, std::int32_t vertex_count,
                         const std::vector<io::Group>& groups, std::int32_t levels)
    : groups_(groups) {
  const FpEnvGuard guard;
  if (levels < 1) throw std::invalid_argument("Subdivision: levels must be at least 1");
  if (!may_subdivide(triangles.size(), levels)) {
    throw std::invalid_argument("Subdivision: so many levels make more faces than a mesh may have");
  }
  for (const io::Group& group : groups) {
    if (!io::is_within(group, triangles.size())) {
      throw std::invalid_argument("Subdivision: a group names faces that do not exist");
    }
  }
  Mesh mesh = make_mesh(vertex_count, triangles);
  for (std::int32_t n = 0; n < levels; ++n) {
    const std::vector<std::uint8_t> rigid = io::body_faces(mesh.faces.size(), groups_);
    for (io::Group& group : groups_) {
      group.face_begin *= 4;
      group.face_end *= 4;
    }
    levels_.push_back(std::make_unique<Level>(n == 0 ? mesh : levels_.back()->mesh, rigid));
    mesh = levels_.back()->mesh;
  }
}

Subdivision::~Subdivision() = default;

const io::Triangles& Subdivision::triangles() const { return levels_.back()->rules.triangles(); }

std::int32_t Subdivision::vertex_count() const { return levels_.back()->mesh.vertex_count; }

Positions Subdivision::operator()(const PositionsRef& V, SubdivisionCounts& counts,
                                  const std::function<bool()>& stop) const {
  const FpEnvGuard guard;
  const auto is_stopped = [&stop] { return stop && stop(); };
  Positions x = V;
  for (const auto& level : levels_) {
    if (is_stopped()) return Positions(0, 3);
    StepMotion motion;
    motion.start(level->rules.midpoints(x), level->rules.smooth(x), CollisionOptions::Precision::kFloat64);
    const Positions way = motion.displacement();
    BoxHierarchy hierarchy(level->mesh);
    const CollisionOptions options{.tolerance_m = 0};
    const ContactTable contacts(level->mesh, options, {});
    CollisionTracker tracker(level->mesh, hierarchy, contacts, options.max_intervals, level->rules.moves());
    std::vector<double> share(static_cast<std::size_t>(level->mesh.vertex_count), 1);
    tracker.start(motion);
    while (tracker.has_motion_collision()) {
      if (is_stopped()) return Positions(0, 3);
      ++counts.rounds;
      stop_before_touch(tracker, share, motion, way);
      tracker.update(motion);
    }
    for (Eigen::Index v = 0; v < way.rows(); ++v) {
      counts.stopped += share[static_cast<std::size_t>(v)] < 1 && !way.row(v).isZero(0) ? 1 : 0;
    }
    x = motion.x();
  }
  return x;
}

}  // namespace selvage::sim
