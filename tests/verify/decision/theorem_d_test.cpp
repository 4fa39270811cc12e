// Theorem D of docs/guarantee-checker.md on small meshes: a mesh that is embedded at t = 0 stays embedded iff there is
// no vertex-face, edge-edge or self event. The left side is judged at many instants by the frame check.
#include <charconv>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "io/mesh_data.h"
#include "tests/verify/motion_families.h"
#include "verify/check.h"

namespace selvage::verify {
namespace {

using testbed::Draw;

struct Complex {
  const char* name;
  std::size_t vertex_count;
  io::Triangles faces;
};

const std::vector<Complex>& complexes() {
  static const std::vector<Complex> kComplexes = {
      {"one face", 3, {{0, 1, 2}}},
      {"two faces at an edge", 4, {{0, 1, 2}, {0, 3, 1}}},
      {"two faces at a vertex", 5, {{0, 1, 2}, {0, 3, 4}}},
      {"two faces apart", 6, {{0, 1, 2}, {3, 4, 5}}},
      {"strip of three", 5, {{0, 1, 2}, {1, 3, 2}, {2, 3, 4}}},
      {"closed fan", 5, {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 1}}},
      {"three faces at an edge", 5, {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}}},
      {"tetrahedron", 4, {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}}},
  };
  return kComplexes;
}

constexpr int kInstants = 48;  // multiples of 1/48: halves, thirds, quarters ... are among them

std::vector<Point> draw_points(Draw& draw, std::size_t count, int range) {
  std::vector<Point> points(count);
  for (Point& point : points) {
    point = draw.point(range);
    for (double& coordinate : point) coordinate *= kInstants;  // whole at every instant
  }
  return points;
}

std::vector<Point> at_instant(const std::vector<Point>& first, const std::vector<Point>& last, int instant) {
  std::vector<Point> points(first.size());
  for (std::size_t v = 0; v < first.size(); ++v) {
    for (std::size_t k = 0; k < 3; ++k) {
      points[v][k] = ((kInstants - instant) * first[v][k] + instant * last[v][k]) / kInstants;
    }
  }
  return points;
}

bool is_embedded(const Complex& complex, const std::vector<Point>& points) {
  return check_frame(Surface{complex.faces, {}}, points, {}).violations_total.total() == 0;
}

/// The instant of an event whose time is exactly one of them.
std::optional<int> instant_of(const ExactTime& t) {
  if (t.lower != t.upper) return std::nullopt;
  const std::size_t slash = t.lower.find('/');
  int numerator = 0, denominator = 1;
  std::from_chars(t.lower.data(), t.lower.data() + t.lower.size(), numerator);
  if (slash != std::string::npos) {
    std::from_chars(t.lower.data() + slash + 1, t.lower.data() + t.lower.size(), denominator);
  }
  if (denominator > kInstants || kInstants % denominator != 0) return std::nullopt;
  return numerator * (kInstants / denominator);
}

struct TheoremTally {
  long motions = 0, clean = 0, broken_at_an_instant = 0, self_only = 0, events_at_instants = 0;
};

void check_theorem(const Complex& complex, Draw& draw, int range, TheoremTally& tally) {
  const std::vector<Point> first = draw_points(draw, complex.vertex_count, range);
  if (!is_embedded(complex, first)) return;
  std::vector<Point> last = first;  // some vertices stay
  const std::vector<Point> moved = draw_points(draw, complex.vertex_count, range);
  for (std::size_t v = 0; v < last.size(); ++v) {
    if (draw.chance(60)) last[v] = moved[v];
  }
  const CheckResult motion = check_motion(Surface{complex.faces, {}}, first, last, {});
  const ViolationCounts& events = motion.violations_total;
  ++tally.motions;
  if (events.total() == 0) ++tally.clean;
  if (events.self > 0 && events.vf == 0 && events.ee == 0) ++tally.self_only;

  bool broken = false;
  for (int instant = 1; instant <= kInstants; ++instant) {
    broken |= !is_embedded(complex, at_instant(first, last, instant));
  }
  if (broken) ++tally.broken_at_an_instant;
  EXPECT_TRUE(!broken || events.total() > 0) << "a failure without an event";
  for (const Violation& event : motion.violations) {
    const std::optional<int> instant = instant_of(event.t);
    if (!instant) continue;
    ++tally.events_at_instants;
    EXPECT_FALSE(is_embedded(complex, at_instant(first, last, *instant))) << "an event without a failure";
  }
}

TEST(TheoremD, EmbeddedForAllTimesIffNoEvent) {
  Draw draw(41);
  long self_only = 0;
  for (const Complex& complex : complexes()) {
    SCOPED_TRACE(complex.name);
    TheoremTally tally;
    for (int i = 0; i < 400 && !::testing::Test::HasFailure(); ++i) {
      SCOPED_TRACE(i);
      check_theorem(complex, draw, 1 + i % 3, tally);
    }
    // Both sides of the theorem were met.
    EXPECT_GT(tally.motions, 50);
    EXPECT_GT(tally.clean, 5);
    EXPECT_GT(tally.broken_at_an_instant, 5);
    EXPECT_GT(tally.events_at_instants, 5);
    self_only += tally.self_only;
  }
  EXPECT_GT(self_only, 5);  // failures that neither vertex-face nor edge-edge events would tell
}

}  // namespace
}  // namespace selvage::verify
