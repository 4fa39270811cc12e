#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <optional>
#include <random>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "tests/verify/frame_plants.h"
#include "tests/verify/sheet.h"
#include "verify/check.h"
#include "verify/decision/exact_distance.h"
#include "verify/decision/exact_overlap.h"
#include "verify/first_violations.h"

namespace selvage::verify {
namespace {

using selvage::testing::add_vertex;
using selvage::testing::point_on;
using selvage::testing::sheet;
using selvage::testing::surface;
using testbed::kPlants;
using testbed::Plant;
using testbed::text;
using testbed::texts;

CheckResult check(const io::MeshData& mesh, CheckOptions options = {}) {
  options.max_violations = 1000000;
  return check_frame(surface(mesh), mesh.points, options);
}

}  // namespace

TEST(FrameCheck, CleanSheetIsCleanAndCounted) {
  const io::MeshData mesh = sheet(20);
  const CheckResult result = check(mesh);
  EXPECT_EQ(result.violations_total.total(), 0);
  EXPECT_EQ(result.pairs.self, 800);
  EXPECT_GE(result.pairs.overlap, 3 * 800 / 2 - 40);  // at least the neighbours across edges
}

// One vertex far away, as exporters write them for "none": all faces fell into one cell, and each met each.
TEST(FrameCheck, AVertexThatNoFaceHoldsIsNoWork) {
  const io::MeshData mesh = sheet(20);
  CheckOptions options;
  for (const std::optional<double> min_distance : {std::optional<double>(), std::optional(0x1p-6)}) {
    options.min_distance = min_distance;
    const CheckResult alone = check(mesh, options);
    for (const double far : {1e12, 1e30, -1e308}) {
      io::MeshData with_far = mesh;
      add_vertex(with_far, {far, far, far});
      const CheckResult result = check(with_far, options);
      EXPECT_EQ(result.block_pairs, alone.block_pairs) << far;
      EXPECT_EQ(texts(result), texts(alone));
    }
  }
}

// A simulation that blew up: its far face has a group of its own at most, and meets what its box does.
TEST(FrameCheck, AFaceFarAwayIsLittleMoreWork) {
  const io::MeshData mesh = sheet(30);
  CheckOptions options;
  for (const std::optional<double> min_distance : {std::optional<double>(), std::optional(0x1p-6)}) {
    options.min_distance = min_distance;
    const CheckResult alone = check(mesh, options);
    for (const double far : {1e12, 1e30, -1e307}) {
      io::MeshData with_far = mesh;
      const std::int32_t a = add_vertex(with_far, {far, far, far}), b = add_vertex(with_far, {2 * far, far, far}),
                         c = add_vertex(with_far, {far, 2 * far, far});
      with_far.triangles.push_back({a, b, c});
      const CheckResult result = check(with_far, options);
      EXPECT_LE(result.block_pairs, alone.block_pairs + alone.block_pairs / 2) << far;
      EXPECT_EQ(texts(result), texts(alone));
    }
  }
}

TEST(FrameCheck, EveryPlantedViolationIsFoundAndNamed) {
  for (const std::int32_t n : {7, 22, 70}) {  // 98, 968, 9800 faces
    const io::MeshData clean = sheet(n);
    ASSERT_EQ(check(clean).violations_total.total(), 0);
    const std::size_t faces = clean.triangles.size();
    for (const Plant& plant : kPlants) {
      for (const std::size_t face : {std::size_t{0}, faces / 2 + 3, faces - 1}) {
        io::MeshData mesh = clean;
        const std::set<std::string> expected = plant.spoil(mesh, face);
        const CheckResult result = check(mesh);
        EXPECT_EQ(texts(result), expected) << plant.why << ", face " << face << " of " << faces;
        EXPECT_EQ(result.violations_total.total(), static_cast<std::int64_t>(expected.size()));
      }
    }
  }
}

TEST(FrameCheck, IsEveryPairOfATangledSoup) {
  std::mt19937 random(21);
  std::uniform_int_distribution<int> lattice(-3, 3);
  for (int round = 0; round < 30; ++round) {
    const bool has_far = round % 2 == 1;  // the frame of the first filter does not hold them
    io::MeshData mesh;
    for (int i = 0; i < 30; ++i) {
      const double far = has_far && i < 3 ? 0x1p+10 : 1;
      mesh.points.push_back({far * lattice(random), far * lattice(random), far * lattice(random)});
    }
    std::uniform_int_distribution<std::int32_t> vertex(0, 29);
    while (mesh.triangles.size() < 40) {
      const std::int32_t a = vertex(random), b = vertex(random), c = vertex(random);
      if (a != b && b != c && c != a) mesh.triangles.push_back({a, b, c});
    }
    const auto corners = [&](std::size_t f) {
      const auto& [a, b, c] = mesh.triangles[f];
      return std::array<Point, 3>{mesh.points[std::size_t(a)], mesh.points[std::size_t(b)],
                                  mesh.points[std::size_t(c)]};
    };
    std::int64_t overlaps = 0, degenerate = 0;
    for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
      degenerate += exact_degenerate(corners(f)).is_degenerate ? 1 : 0;
      for (std::size_t g = f + 1; g < mesh.triangles.size(); ++g) {
        const auto answer = exact_overlap(mesh.triangles[f], corners(f), mesh.triangles[g], corners(g));
        overlaps += answer.kind != OverlapKind::kNone ? 1 : 0;
      }
    }
    const CheckResult result = check(mesh);
    ASSERT_EQ(result.violations_total.overlap, overlaps);
    ASSERT_EQ(result.violations_total.self, degenerate);
    ASSERT_EQ(result.violations.size(), static_cast<std::size_t>(overlaps + degenerate));
    for (const double scale : {0x1p-1074, 0x1p-537, 0x1p-358, 0x1p+341, has_far ? 0x1p+1010 : 0x1p+1020}) {
      io::MeshData scaled = mesh;
      for (Point& p : scaled.points) {
        for (double& x : p) x *= scale;
      }
      ASSERT_EQ(texts(check(scaled)), texts(result)) << scale;
    }
  }
}

// A corner exactly on another face, in numbers so long that heights over the face round: only the margins of the
// filters keep the rounded heights from telling the two faces apart.
TEST(FrameCheck, FacesThatTouchInLongNumbersAreFound) {
  std::mt19937 random(43);
  std::uniform_int_distribution<std::int64_t> number(-(1 << 24), 1 << 24);
  for (int i = 0; i < 2000; ++i) {
    io::MeshData mesh;
    for (int v = 0; v < 3; ++v) {
      mesh.points.push_back({double(4 * number(random)), double(4 * number(random)), double(4 * number(random))});
    }
    mesh.triangles.push_back({0, 1, 2});
    const Point touch = point_on(mesh, 0, {1, 1, 2});
    const auto above = [&](double x, double y) { return Point{touch[0] + x, touch[1] + y, touch[2] + 0x1p+28}; };
    const auto p = add_vertex(mesh, touch);
    const auto q = add_vertex(mesh, above(1, 0));
    mesh.triangles.push_back({p, q, add_vertex(mesh, above(0, 1))});
    ASSERT_EQ(texts(check(mesh)), std::set<std::string>{"overlap touch 0 1"}) << i;
  }
}

TEST(FrameCheck, ListIsSortedCappedAndTheSameForAnyNumberOfThreads) {
  io::MeshData mesh = sheet(30);
  for (std::size_t face = 0; face < 1800; face += 7) {
    const auto p = add_vertex(mesh, point_on(mesh, face, {1, 1, 2}, 0.0625));
    const auto q = add_vertex(mesh, point_on(mesh, face, {1, 1, 2}, -0.0625));
    mesh.triangles.push_back({p, q, add_vertex(mesh, point_on(mesh, face, {1, 2, 1}, 0.0625))});
  }
  const CheckResult all = check(mesh);
  ASSERT_GE(all.violations.size(), 250U);
  for (std::size_t i = 1; i < all.violations.size(); ++i) {
    ASSERT_LT(std::tie(all.violations[i - 1].event, all.violations[i - 1].features),
              std::tie(all.violations[i].event, all.violations[i].features));
  }
  for (const std::size_t threads : std::initializer_list<std::size_t>{1, 2, 3, 8}) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    for (const std::size_t limit : {std::size_t{0}, std::size_t{1}, std::size_t{10}}) {
      const CheckResult capped =
          check_frame(surface(mesh), mesh.points, {.max_violations = limit, .min_distance = {}, .check_bodies = false});
      EXPECT_EQ(capped.violations_total.total(), all.violations_total.total());
      EXPECT_EQ(capped.pairs.overlap, all.pairs.overlap);
      ASSERT_EQ(capped.violations.size(), limit);
      for (std::size_t i = 0; i < limit; ++i) EXPECT_EQ(text(capped.violations[i]), text(all.violations[i]));
    }
  }
}

// The cloth is one block, which meets all faces of the body: 111,104 pairs.
TEST(FrameCheck, IsStoppedWithinABlockOfFacesThatMeetAll) {
  constexpr std::int64_t kMany = 80;  // more than there are blocks, and faces of the cloth
  io::MeshData mesh = sheet(30);
  std::ranges::fill(mesh.points, Point{1, 1, 1});
  std::vector<std::uint8_t> is_body(mesh.triangles.size(), 1);
  std::fill_n(is_body.begin(), 64, 0);
  std::atomic<std::int64_t> asked = 0;
  CheckOptions options;
  options.stop = [&] { return ++asked > kMany; };
  EXPECT_THROW((void)check_frame({mesh.triangles, is_body}, mesh.points, options), Stopped);
  EXPECT_LT(asked, 2 * kMany);
}

// Six sheets at one place.
TEST(FrameCheck, TheFirstViolationsAreTheSameForAnyNumberOfThreadsAndNoMoreIsLookedAt) {
  constexpr std::int32_t kSide = 16, kLayers = 6, kVertices = (kSide + 1) * (kSide + 1);
  const io::MeshData layer = sheet(kSide);
  io::MeshData mesh;
  for (std::int32_t i = 0; i < kLayers; ++i) {
    mesh.points.insert(mesh.points.end(), layer.points.begin(), layer.points.end());
    for (const auto& [a, b, c] : layer.triangles) {
      mesh.triangles.push_back({a + i * kVertices, b + i * kVertices, c + i * kVertices});
    }
  }
  const std::int32_t a = add_vertex(mesh, {20, 0, 0}), b = add_vertex(mesh, {21, 0, 0});
  mesh.triangles.push_back({a, b, add_vertex(mesh, {22, 0, 0})});  // without area, which is looked at last
  const Topology topology = make_topology(surface(mesh), mesh.points.size());
  static std::atomic<std::size_t> looked_at = 0;  // of those that no filter decides, as all that touch
  CheckOptions options;
  options.max_violations = 1'000'000;
  options.second_opinion = SecondOpinionScope::kUndecided;
  using Face = std::array<std::int32_t, 3>;
  using Corners = std::array<Point, 3>;
  options.second_deciders.overlap = [](const Face&, const Corners&, const Face&, const Corners&) {
    return ++looked_at > 0;
  };
  const CheckResult all = check_frame(topology, mesh.points, options);
  ASSERT_GT(all.violations.size(), 90'000U);
  const auto first = [&](std::size_t enough) {
    std::vector<std::string> found;
    for (const Violation& v : first_violations(topology, mesh.points, enough, options)) found.push_back(text(v));
    return found;
  };
  const std::set<std::string> known = texts(all);
  for (const std::size_t enough : std::initializer_list<std::size_t>{1, 10, 63, 64, 65, 5000, 20'000}) {
    std::vector<std::string> alone;
    for (const std::size_t threads : std::initializer_list<std::size_t>{1, 2, 3, 8}) {
      const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
      looked_at = 0;
      const std::vector<std::string> found = first(enough);
      if (threads == 1) {
        EXPECT_LT(looked_at, enough + 1000);
        alone = found;
      }
      ASSERT_EQ(found.size(), enough) << threads;
      EXPECT_EQ(found, alone) << threads;
    }
    for (const std::string& name : alone) EXPECT_TRUE(known.contains(name)) << name;
  }
  std::vector<std::string> names;
  for (const Violation& v : all.violations) names.push_back(text(v));
  EXPECT_EQ(first(names.size() + 1), names) << "where there are less, it is all of them, in their order";
  EXPECT_EQ(first(names.size()), names);
}

TEST(FrameCheck, BodiesAreCheckedAgainstClothAlwaysAndAgainstBodiesOnRequest) {
  io::MeshData mesh;
  mesh.points = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {1, 1, -1}, {1, 1, 1}, {2, 1, 1}, {1, 1, 5}, {1, 1, 6}, {1, 1, 7}};
  mesh.triangles = {{0, 1, 2}, {3, 4, 5}, {6, 7, 8}};
  const auto total = [&](std::vector<std::uint8_t> is_body, bool bodies) {
    return check_frame({mesh.triangles, is_body}, mesh.points,
                       {.max_violations = 100, .min_distance = {}, .check_bodies = bodies})
        .violations_total.total();
  };
  EXPECT_EQ(total({0, 0, 0}, false), 2);
  EXPECT_EQ(total({0, 1, 1}, false), 1);
  EXPECT_EQ(total({1, 0, 1}, false), 1);
  EXPECT_EQ(total({1, 1, 0}, false), 1);
  EXPECT_EQ(total({1, 1, 1}, false), 0);
  EXPECT_EQ(total({1, 1, 1}, true), 2);
}

TEST(FrameCheck, RefusesWhatItCannotJudge) {
  const io::MeshData mesh = sheet(3);
  const auto spoilt = [&](double x) {
    io::MeshData bad = mesh;
    bad.points[5][1] = x;
    return bad;
  };
  EXPECT_THROW(check(spoilt(std::nan(""))), std::invalid_argument);
  EXPECT_THROW(check(spoilt(std::numeric_limits<double>::infinity())), std::invalid_argument);
  io::MeshData bad = mesh;
  bad.triangles[2] = {0, 1, 16};
  EXPECT_THROW(check(bad), std::invalid_argument);
  bad.triangles[2] = {0, 1, -1};
  EXPECT_THROW(check(bad), std::invalid_argument);
  bad.triangles[2] = {0, 1, 1};
  EXPECT_THROW(check(bad), std::invalid_argument);
  EXPECT_THROW(check(mesh, {.max_violations = 100, .min_distance = -1.0}), std::invalid_argument);
  EXPECT_THROW(check(mesh, {.max_violations = 100, .min_distance = std::nan("")}), std::invalid_argument);
}

TEST(FrameCheck, MinimumDistanceIsEveryPairWithoutACommonVertex) {
  std::mt19937 random(23);
  for (int round = 0; round < 6; ++round) {
    io::MeshData mesh = sheet(4);
    std::uniform_real_distribution<double> jitter(-0.25, 0.25);
    for (Point& p : mesh.points) {
      for (double& x : p) x += round % 2 == 0 ? jitter(random) : 0;
    }
    for (const double distance : {0.0, 0.4, 0.70703125, 0.75, 1.0, 1.5}) {
      const Topology topology = make_topology(surface(mesh), mesh.points.size());
      const auto at = [&](std::int32_t v) { return mesh.points[static_cast<std::size_t>(v)]; };
      std::int64_t vf = 0, ee = 0;
      for (std::int32_t v = 0; v < 25; ++v) {
        for (const auto& [a, b, c] : mesh.triangles) {
          if (v == a || v == b || v == c) continue;
          vf += compare_vf_distance({at(v), at(a), at(b), at(c)}, distance) < 0 ? 1 : 0;
        }
      }
      for (std::size_t e = 0; e < topology.edges.size(); ++e) {
        for (std::size_t f = e + 1; f < topology.edges.size(); ++f) {
          const auto& [a, b] = topology.edges[e];
          const auto& [c, d] = topology.edges[f];
          if (a == c || a == d || b == c || b == d) continue;
          ee += compare_ee_distance({at(a), at(b), at(c), at(d)}, distance) < 0 ? 1 : 0;
        }
      }
      const CheckResult result = check(mesh, {.max_violations = 100, .min_distance = distance});
      EXPECT_EQ(result.violations_total.vf, vf) << distance;
      EXPECT_EQ(result.violations_total.ee, ee) << distance;
      EXPECT_EQ(result.violations_total.overlap, 0);
    }
  }
}

}  // namespace selvage::verify
