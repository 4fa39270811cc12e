#include <cmath>
#include <random>
#include <string>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "tests/verify/sheet.h"
#include "verify/check.h"

namespace selvage::verify {
namespace {

using selvage::testing::add_vertex;
using selvage::testing::sheet;
using selvage::testing::surface;

CheckOptions unlimited() { return {.max_violations = 1000000, .min_distance = {}, .check_bodies = false}; }

using Names = std::vector<std::tuple<EventKind, std::int32_t, std::int32_t>>;

Names names(const CheckResult& result) {
  Names found;
  for (const Violation& v : result.violations) found.emplace_back(v.event, v.features[0], v.features[1]);
  return found;
}

/// Every pair there is, without boxes, in the order of the report.
Names brute_force(const io::MeshData& mesh, const io::Points& V_t1) {
  const Topology topology = make_topology(surface(mesh), mesh.points.size());
  const auto& V_t0 = mesh.points;
  const auto at = [](std::int32_t i) { return static_cast<std::size_t>(i); };
  const auto touches = [&](auto query, const auto& vertices) {
    std::array<Point, std::tuple_size_v<std::decay_t<decltype(vertices)>>> x_t0, x_t1;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      x_t0[i] = V_t0[at(vertices[i])];
      x_t1[i] = V_t1[at(vertices[i])];
    }
    return query(x_t0, x_t1, Detail::kDecision).touches;
  };
  Names found;
  const auto face_count = static_cast<std::int32_t>(mesh.triangles.size());
  const auto edge_count = static_cast<std::int32_t>(topology.edges.size());
  for (std::int32_t v = 0; v < static_cast<std::int32_t>(V_t0.size()); ++v) {
    for (std::int32_t f = 0; f < face_count; ++f) {
      const auto& [a, b, c] = mesh.triangles[at(f)];
      if (v == a || v == b || v == c) continue;
      if (touches(exact_vf_motion, std::array{v, a, b, c})) found.emplace_back(EventKind::kVf, v, f);
    }
  }
  for (std::int32_t e = 0; e < edge_count; ++e) {
    for (std::int32_t f = e + 1; f < edge_count; ++f) {
      const auto& [a, b] = topology.edges[at(e)];
      const auto& [c, d] = topology.edges[at(f)];
      if (a == c || a == d || b == c || b == d) continue;
      if (touches(exact_ee_motion, std::array{a, b, c, d})) found.emplace_back(EventKind::kEe, e, f);
    }
  }
  for (std::int32_t v = 0; v < static_cast<std::int32_t>(V_t0.size()); ++v) {
    for (std::int32_t f = 0; f < face_count; ++f) {
      const auto& [a, b, c] = mesh.triangles[at(f)];
      const bool corner = v == a || v == b || v == c;
      const std::array<std::int32_t, 3> query = v == a   ? std::array{a, b, c}
                                                : v == b ? std::array{b, a, c}
                                                         : std::array{c, a, b};
      if (corner && touches(exact_self_motion, query)) found.emplace_back(EventKind::kSelf, v, f);
    }
  }
  return found;
}

}  // namespace

TEST(MotionCheck, AVertexThatNoFaceHoldsIsNoWork) {
  const auto work = [](io::MeshData mesh, const std::vector<Point>& others) {
    for (const Point& p : others) add_vertex(mesh, p);
    std::vector<Point> last = mesh.points;
    for (Point& p : last) p[0] += 0x1p-6;
    const CheckResult result = check_motion(surface(mesh), mesh.points, last, {});
    EXPECT_EQ(result.violations_total.total(), 0);
    return result.block_pairs;
  };
  const io::MeshData mesh = sheet(20);
  const std::int64_t alone = work(mesh, {});
  for (const double far : {1e12, 1e30, -1e308}) EXPECT_EQ(work(mesh, {{far, far, far}}), alone) << far;
}

TEST(MotionCheck, AVertexThatIsThrownFarAwayIsLittleMoreWork) {
  const io::MeshData mesh = sheet(30);
  const auto work = [&](double thrown) {
    std::vector<Point> last = mesh.points;
    for (double& x : last.front()) x += thrown;
    const CheckResult result = check_motion(surface(mesh), mesh.points, last, {});
    EXPECT_EQ(result.violations_total.total(), 0);
    return result.block_pairs;
  };
  const std::int64_t still = work(0);
  for (const double thrown : {-1e12, -1e30, -1e307}) EXPECT_LE(work(thrown), still + still / 2) << thrown;
}

// Swept boxes of a sheet that flies farther than it is wide, or shrinks, all overlap.
TEST(MotionCheck, WhatGoesFarTogetherIsNoMoreWork) {
  const io::MeshData mesh = sheet(30);
  const auto pairs = [&](auto move) {
    std::vector<Point> last = mesh.points;
    for (Point& p : last) move(p);
    const CheckResult result = check_motion(surface(mesh), mesh.points, last, {});
    EXPECT_EQ(result.violations_total.total(), 0);
    return result.pairs.vf + result.pairs.ee;
  };
  const auto fly = [](double way) {
    return [way](Point& p) {
      for (double& x : p) x += way;
    };
  };
  const auto grow = [](double factor) {
    return [factor](Point& p) {
      for (double& x : p) x *= factor;
    };
  };
  const std::int64_t still = pairs(fly(0));
  for (const double way : {-0x1p-6, 1.0, 0x1p+12, 0x1p+30}) EXPECT_EQ(pairs(fly(way)), still) << way;
  for (const double factor : {0.5, 0x1p-20, 0x1p+60}) EXPECT_EQ(pairs(grow(factor)), still) << factor;
}

TEST(MotionCheck, IsEveryPairOfARandomMotion) {
  std::mt19937 random(31);
  std::uniform_int_distribution<int> lattice(-2, 2);
  std::int64_t found = 0;
  for (int round = 0; round < 12; ++round) {
    io::MeshData mesh = sheet(3);
    io::Points V_t1 = mesh.points;
    for (Point& p : V_t1) {
      for (double& x : p) x += round % 3 == 0 ? lattice(random) : 0.125 * lattice(random);
    }
    if (round % 4 == 1) V_t1[0][2] += 0x1p+40 * lattice(random);
    const Names expected = brute_force(mesh, V_t1);
    const CheckResult result = check_motion(surface(mesh), mesh.points, V_t1, unlimited());
    ASSERT_EQ(names(result), expected);
    ASSERT_EQ(result.violations_total.total(), static_cast<std::int64_t>(expected.size()));
    found += result.violations_total.total();
  }
  EXPECT_GE(found, 60);
}

TEST(MotionCheck, NoMotionOfACleanSheetIsClean) {
  const io::MeshData mesh = sheet(10);
  const CheckResult result = check_motion(surface(mesh), mesh.points, mesh.points, unlimited());
  EXPECT_EQ(result.violations_total.total(), 0);
  EXPECT_EQ(result.pairs.self, 3 * 200);
  EXPECT_GT(result.pairs.vf, 0);
  EXPECT_GT(result.pairs.ee, 0);
}

// A corner that crosses the opposite edge of its own face, a boundary edge: no vertex-face pair and no edge-edge pair
// of features without a common vertex sees it, and both ends of the motion are embedded.
TEST(MotionCheck, CornerThroughItsOwnOppositeEdgeIsASelfEvent) {
  const io::MeshData mesh{{{0, 0, 0}, {4, 0, 0}, {1, 2, 0}}, {{0, 1, 2}}, {}, {}};
  const io::Points V_t1 = {{0, 0, 0}, {4, 0, 0}, {1, -2, 0}};
  EXPECT_EQ(check_frame(surface(mesh), mesh.points, {}).violations_total.total(), 0);
  EXPECT_EQ(check_frame(surface(mesh), V_t1, {}).violations_total.total(), 0);
  const CheckResult result = check_motion(surface(mesh), mesh.points, V_t1, {});
  EXPECT_EQ(result.pairs.vf + result.pairs.ee, 0);
  ASSERT_EQ(names(result), (Names{{EventKind::kSelf, 2, 0}}));
  EXPECT_EQ(result.violations[0].t.lower, "1/2");
  EXPECT_EQ(result.violations[0].t.upper, "1/2");
  EXPECT_TRUE(result.violations[0].motion);
}

TEST(MotionCheck, SingleVertexThroughASheetIsNamedWithItsTime) {
  for (const std::int32_t n : {7, 30}) {
    io::MeshData mesh = sheet(n);
    const std::size_t face = mesh.triangles.size() / 2;
    const auto p = testing::add_vertex(mesh, testing::point_on(mesh, face, {1, 1, 2}, 0.25));
    const auto q = testing::add_vertex(mesh, testing::point_on(mesh, face, {1, 1, 2}, 2));
    const auto r = testing::add_vertex(mesh, testing::point_on(mesh, face, {2, 1, 1}, 2));
    mesh.triangles.push_back({p, q, r});
    io::Points V_t1 = mesh.points;
    V_t1[static_cast<std::size_t>(p)][2] -= 0.75;
    const CheckResult result = check_motion(surface(mesh), mesh.points, V_t1, unlimited());
    ASSERT_EQ(result.violations_total.vf, 1);
    EXPECT_EQ(result.violations[0].kind, "cross");
    EXPECT_EQ(result.violations[0].features, (std::array{p, static_cast<std::int32_t>(face)}));
    EXPECT_LE(result.violations[0].t.lower_approx, 1.0 / 3);
    EXPECT_GE(result.violations[0].t.upper_approx, 1.0 / 3);
    EXPECT_LE(result.violations[0].t.upper_approx - result.violations[0].t.lower_approx, 0x1p-52);
    EXPECT_NEAR(result.violations[0].at_touch.at(0)[2], testing::point_on(mesh, face, {1, 1, 2})[2], 1e-15);
    V_t1[static_cast<std::size_t>(p)][2] += 0.515625;  // now it stops 1/64 above the face
    EXPECT_EQ(check_motion(surface(mesh), mesh.points, V_t1, unlimited()).violations_total.total(), 0);
  }
}

TEST(MotionCheck, BodyPairsOnRequestOnly) {
  const io::MeshData mesh{
      {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {1, 1, 1}, {2, 1, 1}, {1, 2, 1}}, {{0, 1, 2}, {3, 4, 5}}, {}, {}};
  io::Points V_t1 = mesh.points;
  for (std::size_t i = 3; i < 6; ++i) V_t1[i][2] = -1;
  const auto total = [&](std::vector<std::uint8_t> is_body, bool bodies) {
    return check_motion({mesh.triangles, is_body}, mesh.points, V_t1,
                        {.max_violations = 100, .min_distance = {}, .check_bodies = bodies})
        .violations_total.total();
  };
  EXPECT_EQ(total({0, 0}, false), 3);
  EXPECT_EQ(total({1, 0}, false), 3);
  EXPECT_EQ(total({0, 1}, false), 3);
  EXPECT_EQ(total({1, 1}, false), 0);
  EXPECT_EQ(total({1, 1}, true), 3);
}

TEST(MotionCheck, ABodysCornerThroughItsOwnFaceOnRequestOnly) {
  const io::MeshData mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}, {}, {}};
  const io::Points V_t1 = {{0, 0, 0}, {1, 0, 0}, {0.3, -1, 0}};
  const std::vector<std::uint8_t> is_body = {1};
  for (const bool bodies : {false, true}) {
    const CheckResult result = check_motion({mesh.triangles, is_body}, mesh.points, V_t1,
                                            {.max_violations = 100, .min_distance = {}, .check_bodies = bodies});
    EXPECT_EQ(result.violations_total.self, bodies ? 1 : 0);
  }
}

TEST(MotionCheck, IsTheSameForAnyNumberOfThreads) {
  std::mt19937 random(37);
  std::uniform_int_distribution<int> lattice(-3, 3);
  io::MeshData mesh = sheet(16);
  io::Points V_t1 = mesh.points;
  for (Point& p : V_t1) p[2] += 0.25 * lattice(random);
  const CheckResult first =
      check_motion(surface(mesh), mesh.points, V_t1, {.max_violations = 50, .min_distance = {}, .check_bodies = false});
  for (const std::size_t threads : std::initializer_list<std::size_t>{1, 2, 5}) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    const CheckResult again = check_motion(surface(mesh), mesh.points, V_t1,
                                           {.max_violations = 50, .min_distance = {}, .check_bodies = false});
    EXPECT_EQ(names(again), names(first));
    EXPECT_EQ(again.pairs.exact, first.pairs.exact);
    EXPECT_EQ(again.violations_total.total(), first.violations_total.total());
    for (std::size_t i = 0; i < again.violations.size(); ++i) {
      EXPECT_EQ(again.violations[i].t.lower, first.violations[i].t.lower);
    }
  }
}

TEST(MotionCheck, RefusesFramesThatDoNotFit) {
  const io::MeshData mesh = sheet(3);
  io::Points V_t1 = mesh.points;
  V_t1.pop_back();
  EXPECT_THROW(static_cast<void>(check_motion(surface(mesh), mesh.points, V_t1, {})), std::invalid_argument);
  V_t1 = mesh.points;
  V_t1[3][0] = std::nan("");
  EXPECT_THROW(static_cast<void>(check_motion(surface(mesh), mesh.points, V_t1, {})), std::invalid_argument);
}

}  // namespace selvage::verify
