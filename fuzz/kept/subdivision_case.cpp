#include "fuzz/kept/subdivision_case.h"

#include <algorithm>

#include "fuzz/draw/step_world.h"
#include "fuzz/oracle/check_facts.h"
#include "kernel/assert.h"
#include "sim/subdivision/subdivision.h"

namespace selvage::fuzz {
namespace {

constexpr int kMaxLevels = 3;  // 64 faces for one

/// A surface as files have it: bodies are ranges of faces.
struct Frame {
  io::Triangles triangles;
  std::vector<io::Group> groups;
  Positions x;
};

Frame frame_of(const MeshCase& kept) {
  Frame frame{kept.faces, {}, kept.x[0]};
  for (std::int32_t f = 0; f < std::ssize(frame.triangles); ++f) {
    const auto is_scripted = [&](std::int32_t vertex) { return kept.marks[0][static_cast<std::size_t>(vertex)] != 0; };
    const bool is_body = std::ranges::all_of(frame.triangles[static_cast<std::size_t>(f)], is_scripted);
    const io::Group::Role role = is_body ? io::Group::Role::kBody : io::Group::Role::kCloth;
    if (frame.groups.empty() || frame.groups.back().role != role) frame.groups.push_back({"", role, f, f});
    ++frame.groups.back().face_end;
  }
  return frame;
}

verify::Topology topology_of(const Frame& frame) {
  const std::vector<std::uint8_t> is_body = io::body_faces(frame.triangles.size(), frame.groups);
  return verify::make_topology({frame.triangles, is_body}, static_cast<std::size_t>(frame.x.rows()));
}

bool bodies_moved(const Frame& fine, const Positions& start) {
  const std::vector<std::uint8_t> is_body = io::body_faces(fine.triangles.size(), fine.groups);
  for (std::size_t f = 0; f < is_body.size(); ++f) {
    for (const VertexId v : fine.triangles[f]) {
      if (is_body[f] != 0 && fine.x.row(v) != start.row(v)) return true;
    }
  }
  return false;
}

/// One level; false ends the trial.
bool subdivide(Frame& frame, SubdivisionTrial& trial) {
  const sim::Subdivision subdivision(frame.triangles, static_cast<std::int32_t>(frame.x.rows()), frame.groups, 1);
  sim::SubdivisionCounts counts;
  const Frame fine{subdivision.triangles(), subdivision.groups(), subdivision(frame.x, counts)};
  const verify::Topology topology = topology_of(fine);
  const sim::LoopRules rules(make_mesh(static_cast<std::int32_t>(frame.x.rows()), frame.triangles),
                             io::body_faces(frame.triangles.size(), frame.groups));
  const Positions start = rules.midpoints(frame.x);
  const std::vector<verify::Point> before = sim::points_of(start), after = sim::points_of(fine.x);
  const std::string level = "level " + std::to_string(trial.levels + 1);
  auto& [failure, facts, unfit] = trial.retrial;
  if (verify::check_frame(topology, before, {}).violations_total.total() > 0) {
    trial.is_rounded = true;
    facts.push_back("the midpoints of " + level + ", rounded, intersect: what follows is not promised");
    return false;
  }
  ++trial.levels;
  trial.stopped += counts.stopped > 0 ? 1 : 0;
  facts.push_back(level + ": " + std::to_string(counts.stopped) + " vertices stopped before a touch, in " +
                  std::to_string(counts.rounds) + " rounds");
  const verify::CheckResult motion = verify::check_motion(topology, before, after, {});
  const verify::CheckResult end = verify::check_frame(topology, after, {});
  append_facts(facts, "the motion of " + level, motion);
  append_facts(facts, "the frame after " + level, end);
  if (motion.violations_total.total() > 0) failure = "touches";
  if (end.violations_total.total() > 0) failure = "intersects";
  if (bodies_moved(fine, start)) failure = "body-moved";
  frame = fine;
  return failure.empty();
}

Retrial retry_subdivision(const MeshCase& kept) {
  if (!(kept.x[0].cwiseAbs().maxCoeff() <= kMaxCoordinate)) return {{}, {}, "a vertex is outside the domain"};
  const Frame frame = frame_of(kept);
  const auto start = verify::check_frame(topology_of(frame), sim::points_of(frame.x), {});
  if (start.violations_total.total() > 0) return {{}, {}, "the surface intersects itself at the start"};
  return try_subdivision(kept).retrial;
}

}  // namespace

const MeshKind& subdivision_kind() {
  static const MeshKind kind{"subdivision",
                             "frames free of intersections stay free when they are subdivided (paper, section 8)",
                             {"x"},
                             0,
                             {{"levels", 1, 1, kMaxLevels, true}},
                             {{"scripted", 0, 0, 1, true}},
                             retry_subdivision};
  return kind;
}

MeshCase subdivision_case(const io::Triangles& faces, const Positions& x, const std::vector<double>& is_scripted,
                          int levels) {
  return {&subdivision_kind(), {static_cast<double>(levels)}, {x}, {is_scripted}, faces};
}

SubdivisionTrial try_subdivision(const MeshCase& kept) {
  SubdivisionTrial trial;
  Frame frame = frame_of(kept);
  for (int level = 0; level < static_cast<int>(kept.settings[0]); ++level) {
    if (!subdivide(frame, trial)) break;
  }
  return trial;
}

}  // namespace selvage::fuzz
