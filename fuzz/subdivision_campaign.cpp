#include "fuzz/subdivision_campaign.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "fuzz/step_oracle.h"
#include "kernel/assert.h"
#include "sim/subdivision.h"

namespace selvage::fuzz {
namespace {

constexpr const char* kTents = "tents";

/// A surface as files have it: bodies are ranges of faces.
struct Frame {
  io::Triangles triangles;
  std::vector<io::Group> groups;
  Positions x;
};

Frame frame_of(const StepWorld& world, const Positions& x) {
  Frame frame{{world.mesh.faces.begin(), world.mesh.faces.end()}, {}, x};
  for (std::int32_t f = 0; f < std::ssize(frame.triangles); ++f) {
    const bool is_body = std::ranges::all_of(frame.triangles[static_cast<std::size_t>(f)],
                                             [&](std::int32_t vertex) { return world.is_scripted(vertex); });
    const io::Group::Role role = is_body ? io::Group::Role::kBody : io::Group::Role::kCloth;
    if (frame.groups.empty() || frame.groups.back().role != role) frame.groups.push_back({"", role, f, f});
    ++frame.groups.back().face_end;
  }
  return frame;
}

/// Two tents, or valleys, one over the other: smoothing moves the ridge of the coarser one more, through the other.
Frame tents(ChoiceSource& source) {
  const double slope = std::ldexp(source.coin() ? 1.0 : -1.0, source.range(-3, 3));
  const double gap = std::ldexp(1.0, -source.range(0, 20));
  Frame frame;
  std::vector<Vec3> points;
  for (int layer = 0; layer < 2; ++layer) {
    const auto first = static_cast<std::int32_t>(points.size());
    const int columns = 2 * source.range(1, 4), rows = source.range(1, 4);
    for (int row = 0; row <= rows; ++row) {
      for (int column = 0; column <= columns; ++column) {
        const double x = 2.0 * column / columns - 1;
        points.emplace_back(x, 2.0 * row / rows, slope * std::abs(x) + layer * gap);
      }
    }
    for (int row = 0; row < rows; ++row) {
      for (int column = 0; column < columns; ++column) {
        const std::int32_t corner = first + row * (columns + 1) + column, above = corner + columns + 1;
        frame.triangles.push_back({corner, corner + 1, above + 1});
        frame.triangles.push_back({corner, above + 1, above});
      }
    }
  }
  frame.x.resize(std::ssize(points), 3);
  for (Eigen::Index i = 0; i < frame.x.rows(); ++i) frame.x.row(i) = points[static_cast<std::size_t>(i)];
  frame.groups = {{"", io::Group::Role::kCloth, 0, static_cast<std::int32_t>(frame.triangles.size())}};
  return frame;
}

std::vector<std::uint8_t> body_faces(const std::vector<io::Group>& groups) {
  std::vector<std::uint8_t> flags;
  for (const io::Group& group : groups) {
    flags.insert(flags.end(), static_cast<std::size_t>(group.face_end - group.face_begin),
                 group.role == io::Group::Role::kBody ? 1 : 0);
  }
  return flags;
}

Mesh mesh_of(const Frame& frame) {
  Faces faces(std::ssize(frame.triangles), 3);
  for (Eigen::Index f = 0; f < faces.rows(); ++f) {
    const auto& triangle = frame.triangles[static_cast<std::size_t>(f)];
    faces.row(f) << triangle[0], triangle[1], triangle[2];
  }
  return make_mesh(static_cast<std::int32_t>(frame.x.rows()), faces);
}

/// The shortest decimal number that reads back as x.
std::string decimal(double x) {
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), x).ptr;
  return {text.data(), end};
}

struct Level {
  Frame fine;
  sim::SubdivisionCounts counts;
  bool rounds_into_touch = false;  ///< the midpoints, rounded, intersect: what follows is not promised
  std::string failure;
};

Level subdivide(const Frame& frame) {
  Level level;
  const sim::Subdivision subdivision(frame.triangles, static_cast<std::int32_t>(frame.x.rows()), frame.groups, 1);
  level.fine = {subdivision.triangles(), subdivision.groups(), subdivision(frame.x, level.counts)};
  const std::vector<std::uint8_t> is_body = body_faces(level.fine.groups);
  SELVAGE_ASSERT(is_body.size() == level.fine.triangles.size());
  const auto vertex_count = static_cast<std::size_t>(level.fine.x.rows());
  const verify::Topology topology = verify::make_topology({level.fine.triangles, is_body}, vertex_count);

  const sim::LoopRules rules(mesh_of(frame), body_faces(frame.groups));
  const Positions start = rules.midpoints(frame.x);
  const std::vector<verify::Point> before = raw_points(start), after = raw_points(level.fine.x);
  level.rounds_into_touch = verify::check_frame(topology, before, {}).violations_total.total() > 0;
  if (level.rounds_into_touch) return level;
  if (verify::check_motion(topology, before, after, {}).violations_total.total() > 0) level.failure = "touches";
  if (verify::check_frame(topology, after, {}).violations_total.total() > 0) level.failure = "intersects";
  for (std::size_t f = 0; f < is_body.size(); ++f) {
    for (const VertexId v : level.fine.triangles[f]) {
      if (is_body[f] != 0 && level.fine.x.row(v) != start.row(v)) level.failure = "body-moved";
    }
  }
  return level;
}

class SubdivisionCampaign final : public Property {
 public:
  SubdivisionCampaign()
      : Property("subdivision", "frames free of intersections stay free when they are subdivided (paper, section 8)") {
    for (const SurfaceClass& surface : surface_classes()) streams_.push_back({std::string(surface.name), 0, 1});
    streams_.push_back({kTents, 0, 8});
    counters_ = {"levels", "stopped", "rounded"};
  }

  Outcome run(const Stream& stream, ChoiceSource source) override {
    Outcome outcome{{1, 0, {}, 0}, {}};
    Frame frame = first_frame(stream, source);
    for (int levels = source.range(1, 2); levels > 0; --levels) {
      Level level = subdivide(frame);
      if (level.rounds_into_touch) {
        ++outcome.counts.of[2];
        break;
      }
      ++outcome.counts.of[0];
      outcome.counts.of[1] += level.counts.stopped > 0;
      if (!level.failure.empty()) {
        outcome.counts.failures = 1;
        outcome.failure = level.failure;
        break;
      }
      frame = std::move(level.fine);
    }
    return outcome;
  }

  [[nodiscard]] std::string complaint(const Stream& stream, const Counts& counts) const override {
    if (counts.cases <= 100) return "";
    if (counts.of[0] * 2 < counts.cases) return "rounding spoils most of the surfaces";
    // Measured: a fifth of the levels.
    return stream.name == kTents && counts.of[1] * 20 < counts.of[0] ? "hardly anything has to stop" : "";
  }

  /// The frame that was to be subdivided, as an OBJ.
  std::string kept(const Stream& stream, ChoiceSource source, const std::string& origin, const std::string& failure,
                   bool /*shrunk*/) override {
    const Frame frame = first_frame(stream, source);
    std::string text = "# " + origin + ": " + failure + "\n";
    for (Eigen::Index i = 0; i < frame.x.rows(); ++i) {
      text += "v " + decimal(frame.x(i, 0)) + " " + decimal(frame.x(i, 1)) + " " + decimal(frame.x(i, 2)) + "\n";
    }
    for (const auto& [a, b, c] : frame.triangles) {
      text += "f " + std::to_string(a + 1) + " " + std::to_string(b + 1) + " " + std::to_string(c + 1) + "\n";
    }
    return text;
  }

 private:
  /// Up to two steps with hostile candidates leave the surface crumpled and in contact: as they were made, surfaces
  /// are so even that smoothing hardly moves them.
  static Frame first_frame(const Stream& stream, ChoiceSource& source) {
    if (stream.name == kTents) return tents(source);
    const auto surface = std::ranges::find(surface_classes(), stream.name, &SurfaceClass::name);
    SELVAGE_ASSERT(surface != surface_classes().end());
    const StepWorld world = make_step_world(source, *surface);
    Positions x = world.x;
    for (int steps = source.range(0, 2); steps > 0; --steps) {
      std::string_view candidate_class;
      const Positions candidate = choose_candidate(source, world, x, candidate_class);
      x = selvage_step(world, x, candidate).x;
    }
    return frame_of(world, x);
  }
};

}  // namespace

std::unique_ptr<Property> make_subdivision_campaign() { return std::make_unique<SubdivisionCampaign>(); }

}  // namespace selvage::fuzz
