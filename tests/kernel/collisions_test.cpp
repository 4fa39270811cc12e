#include "kernel/collisions.h"

#include <cfenv>
#include <cstring>
#include <limits>

#include <gtest/gtest.h>

#include "tests/fp_control.h"
#include "tests/host_environment.h"
#include "tests/kernel/left_out.h"
#include "tests/kernel/random_motion.h"
#include "tests/kernel/with_threads.h"
#include "tests/property.h"

namespace selvage {

namespace {

template <std::size_t N>
std::array<Vec3, N> points(const PositionsRef& V, const std::array<VertexId, 4>& vertices) {
  std::array<Vec3, N> x;
  for (std::size_t k = 0; k < N; ++k) x[k] = V.row(vertices[k]).transpose();
  return x;
}

bool same_bits(double a, double b) { return std::memcmp(&a, &b, sizeof(double)) == 0; }

bool same(const CcdResult& a, const CcdResult& b) {
  bool equal = a.verdict == b.verdict && a.cause == b.cause && a.intervals == b.intervals &&
               same_bits(a.toi_lower, b.toi_lower) && same_bits(a.gap_bound, b.gap_bound);
  for (std::size_t k = 0; k < 4; ++k) equal = equal && same_bits(a.weights[k], b.weights[k]);
  for (Eigen::Index k = 0; k < 3; ++k) equal = equal && same_bits(a.normal[k], b.normal[k]);
  return equal;
}

/// What find_collisions promises, one pair after another.
class Reference {
 public:
  Reference(const Mesh& mesh, const testing::RandomMotion& motion, const CcdOptions& options, MotionBoxes boxes)
      : mesh_(mesh), motion_(motion), options_(options) {
    const CandidateOptions candidate_options{options.tolerance, motion.active, boxes};
    const Candidates candidates = find_candidates_brute_force(mesh, motion.V_t0, motion.V_t1, candidate_options);
    report_.vf_candidates = static_cast<std::int64_t>(candidates.vf.size());
    report_.ee_candidates = static_cast<std::int64_t>(candidates.ee.size());
    const CandidateOptions moving{options.tolerance, motion.active, MotionBoxes::kMoving};
    const Candidates near = find_candidates_brute_force(mesh, motion.V_t0, motion.V_t1, moving);
    for (const auto& pair : candidates.vf) query(PairKind::kVf, pair.vertex, pair.face, is_in(near.vf, pair));
    for (const auto& pair : candidates.ee) query(PairKind::kEe, pair.a, pair.b, is_in(near.ee, pair));
    for (VertexId v = 0; v < mesh.vertex_count; ++v) {
      for (std::size_t f = 0; f < mesh.faces.size(); ++f) query_self(v, static_cast<FaceId>(f));
    }
  }
  /// Whether swept boxes find nothing that moving ones do not.
  [[nodiscard]] bool loses_none() const { return loses_none_; }
  [[nodiscard]] std::size_t candidate_count() const {
    return static_cast<std::size_t>(report_.vf_candidates + report_.ee_candidates);
  }
  /// The same pairs in the same order with the same bits, but for those that may be left out.
  [[nodiscard]] bool agrees_with(const CollisionReport& found) const {
    const auto& all = report_.collisions;
    double toi_lower = 1;
    std::size_t next = 0;
    for (std::size_t i = 0; i < all.size(); ++i) {
      const bool is_next = next < found.collisions.size() && found.collisions[next].kind == all[i].kind &&
                           found.collisions[next].first == all[i].first &&
                           found.collisions[next].second == all[i].second;
      if (!is_next) {
        if (!may_be_left_out(all[i])) return false;
        continue;
      }
      if (!same(found.collisions[next++].ccd, all[i].ccd)) return false;
      toi_lower = std::min(toi_lower, all[i].ccd.toi_lower);
    }
    const std::int64_t queries = report_.vf_candidates + report_.ee_candidates + report_.self_candidates;
    return next == found.collisions.size() && same_bits(found.toi_lower, toi_lower) &&
           found.vf_candidates == report_.vf_candidates && found.ee_candidates == report_.ee_candidates &&
           found.self_candidates == report_.self_candidates && found.intervals >= queries &&
           found.intervals <= report_.intervals;
  }

 private:
  [[nodiscard]] bool may_be_left_out(const Collision& pair) const {
    return testing::may_be_left_out(mesh_, motion_.V_t0, motion_.V_t1, pair, options_.tolerance);
  }
  template <typename Pair>
  static bool is_in(const std::vector<Pair>& sorted, const Pair& pair) {
    return std::binary_search(sorted.begin(), sorted.end(), pair);
  }
  void query(PairKind kind, std::int32_t first, std::int32_t second, bool is_near = true) {
    const auto vertices = pair_vertices(mesh_, kind, first, second);
    const auto ask = [&](auto function, auto n) {
      constexpr std::size_t kCount = decltype(n)::value;
      return function(points<kCount>(motion_.V_t0, vertices), points<kCount>(motion_.V_t1, vertices), options_);
    };
    using Three = std::integral_constant<std::size_t, 3>;
    using Four = std::integral_constant<std::size_t, 4>;
    const CcdResult ccd = kind == PairKind::kSelf ? ask(self_ccd, Three())
                          : kind == PairKind::kVf ? ask(vf_ccd, Four())
                                                  : ask(ee_ccd, Four());
    report_.intervals += ccd.intervals;
    if (ccd.verdict == CcdVerdict::kSeparated) return;
    const Collision pair{kind, first, second, ccd};
    if (is_near) {
      report_.collisions.push_back(pair);
    } else {
      loses_none_ = loses_none_ && may_be_left_out(pair);
    }
  }
  /// The vertex and its opposite edge as a mesh of their own: a face and a copy of the vertex that is no corner of it.
  /// Their boxes overlap if and only if that of the copy overlaps the opposite edge's, which ee_candidates would say.
  void query_self(VertexId v, FaceId f) {
    const auto& corners = mesh_.faces[static_cast<std::size_t>(f)];
    const auto own = std::find(corners.begin(), corners.end(), v);
    if (own == corners.end()) return;
    const auto active = [&](VertexId u) {
      return motion_.active.empty() || motion_.active[static_cast<std::size_t>(u)] != 0;
    };
    if (std::none_of(corners.begin(), corners.end(), active)) return;
    // Edge (v, v') with v' a copy of v has the box of v alone.
    Faces F(2, 3);
    F << 0, 1, 2, 3, 4, 5;
    const Mesh pair = make_mesh(6, F);
    Positions V_t0(6, 3), V_t1(6, 3);
    const auto k = own - corners.begin();
    const std::array<VertexId, 6> rows = {v,
                                          v,
                                          v,
                                          corners[static_cast<std::size_t>((k + 1) % 3)],
                                          corners[static_cast<std::size_t>((k + 2) % 3)],
                                          corners[static_cast<std::size_t>((k + 2) % 3)]};
    for (std::size_t i = 0; i < 6; ++i) {
      V_t0.row(static_cast<Eigen::Index>(i)) = motion_.V_t0.row(rows[i]);
      V_t1.row(static_cast<Eigen::Index>(i)) = motion_.V_t1.row(rows[i]);
    }
    const Candidates found = find_candidates_brute_force(pair, V_t0, V_t1, {options_.tolerance, {}});
    if (std::find(found.vf.begin(), found.vf.end(), VfCandidate{0, 1}) == found.vf.end()) return;
    ++report_.self_candidates;
    query(PairKind::kSelf, v, f);
  }

  const Mesh& mesh_;
  const testing::RandomMotion& motion_;
  CcdOptions options_;
  CollisionReport report_;
  bool loses_none_ = true;
};

CollisionReport find(const Mesh& mesh, const PositionsRef& V_t0, const PositionsRef& V_t1, const CcdOptions& options) {
  BoxHierarchy hierarchy(mesh);
  return find_collisions(mesh, hierarchy, V_t0, V_t1, options);
}

/// A face, and a large one that stands on its corner 3, a unit above the first.
struct FaceAndVertex {
  Mesh mesh;
  Positions V;
  FaceAndVertex() : V(6, 3) {
    Faces F(2, 3);
    F << 0, 1, 2, 3, 4, 5;
    mesh = make_mesh(6, F);
    V << 0, 0, 0, 4, 0, 0, 0, 4, 0, 1, 1, 1, -3, 1, 9, 5, 1, 9;
  }
};

}  // namespace

/// For any number of threads: the pairs and bits of single queries, and the counts of one thread.
TEST(FindCollisions, PropEqualsOneQueryAfterAnother) {
  testing::check_property(150, 8, [] {
    const auto shape = testing::random_shape();
    const auto motion = testing::random_motion(shape.vertex_count);
    RC_LOG() << shape << '\n' << motion << '\n';
    const Mesh mesh = make_mesh(shape.vertex_count, shape.F);
    const CcdOptions options = {motion.reach, 8};  // few intervals: what is compared is the order, not the depth
    const Reference swept(mesh, motion, options, MotionBoxes::kSwept);
    const Reference moving(mesh, motion, options, MotionBoxes::kMoving);
    BoxHierarchy hierarchy(mesh);
    CollisionReport report, of_one_thread;
    CollisionReport in_parts, in_parts_of_one_thread;  // not listed before they are asked
    const auto find_some = [&](const CollisionLimits& limits) {
      return find_collisions(mesh, hierarchy, motion.V_t0, motion.V_t1, options, motion.active, limits);
    };
    const auto find_all = [&](std::size_t most_listed) { return find_some({.most_listed = most_listed}); };
    // Given up exactly where one more is found than wanted.
    const auto ends_at = [&](std::size_t most_listed, const CollisionReport& all) {
      const auto count = [&](CcdCause cause) {
        return static_cast<std::size_t>(
            std::ranges::count(all.collisions, cause, [](const Collision& c) { return c.ccd.cause; }));
      };
      const auto gives_up = [&](const CollisionLimits& limits) {
        const CollisionReport fewer = find_some(limits);
        return !fewer.is_complete && fewer.collisions.empty() && fewer.toi_lower == 0;
      };
      const std::size_t motions = count(CcdCause::kMotion), near = count(CcdCause::kEnd);
      if (motions + near != all.collisions.size()) return false;
      if (!find_some({most_listed, motions, near}).is_complete) return false;
      if (motions > 0 && !gives_up({most_listed, motions - 1, near})) return false;
      return near == 0 || gives_up({most_listed, motions, near - 1});
    };
    bool ends_in_threads = false, ends_in_one = false;
    testing::with_threads(*rc::gen::element(2, 3, 8), [&] {
      report = find_all(CollisionLimits{}.most_listed);
      in_parts = find_all(1);
      ends_in_threads = ends_at(CollisionLimits{}.most_listed, report) && ends_at(1, in_parts);
    });
    testing::with_threads(1, [&] {
      of_one_thread = find_all(CollisionLimits{}.most_listed);
      in_parts_of_one_thread = find_all(1);
      ends_in_one = ends_at(CollisionLimits{}.most_listed, of_one_thread) && ends_at(1, in_parts_of_one_thread);
    });
    RC_ASSERT(ends_in_threads);
    RC_ASSERT(ends_in_one);
    RC_ASSERT(swept.loses_none());
    const Reference& expected = swept.candidate_count() > few_candidates(mesh) ? moving : swept;
    RC_ASSERT(expected.agrees_with(report));
    RC_ASSERT(expected.agrees_with(of_one_thread));
    const Reference& expected_in_parts = swept.candidate_count() > 1 ? moving : swept;
    RC_ASSERT(expected_in_parts.agrees_with(in_parts));
    RC_ASSERT(expected_in_parts.agrees_with(in_parts_of_one_thread));
    RC_ASSERT(in_parts.intervals == in_parts_of_one_thread.intervals);
    RC_ASSERT(report.intervals == of_one_thread.intervals);
    RC_ASSERT(report.collisions.size() == of_one_thread.collisions.size());
  });
}

TEST(FindCollisions, AVertexThroughAFaceIsFoundAtItsTime) {
  const FaceAndVertex scene;
  Positions V_t1 = scene.V;
  V_t1(3, 2) = -1;  // meets the face at t = 1/2
  const CollisionReport report = find(scene.mesh, scene.V, V_t1, {1e-6, 4096});
  ASSERT_EQ(report.collisions.size(), 1U);
  EXPECT_EQ(report.collisions[0].kind, PairKind::kVf);
  EXPECT_EQ(report.collisions[0].first, 3);
  EXPECT_EQ(report.collisions[0].second, 0);
  EXPECT_EQ(report.collisions[0].ccd.cause, CcdCause::kMotion);
  EXPECT_LE(report.toi_lower, 0.5);
  EXPECT_GT(report.toi_lower, 0.499);
}

TEST(FindCollisions, AStepWithoutMotionFindsWhatIsNear) {
  FaceAndVertex scene;
  EXPECT_TRUE(find(scene.mesh, scene.V, scene.V, {0.99, 4096}).collisions.empty());
  const CollisionReport near = find(scene.mesh, scene.V, scene.V, {1.01, 4096});
  ASSERT_EQ(near.collisions.size(), 1U);
  EXPECT_EQ(near.collisions[0].ccd.cause, CcdCause::kEnd);
  EXPECT_EQ(near.toi_lower, 1);
  scene.V(3, 2) = 0;
  EXPECT_EQ(find(scene.mesh, scene.V, scene.V, {0, 4096}).toi_lower, 0);
}

/// A strip of 2 x 200 faces that flies by 40 m, and crosses a face far away half-way.
TEST(FindCollisions, WhatFliesTogetherIsNoCandidateAndWhatItCrossesIs) {
  constexpr VertexId kSide = 201;
  Faces F(2 * (kSide - 1) + 1, 3);
  Positions V_t0(2 * kSide + 3, 3);
  for (VertexId i = 0; i < kSide; ++i) {
    V_t0.row(2 * i) << 0.1 * i, 0, 0;
    V_t0.row(2 * i + 1) << 0.1 * i, 0.1, 0;
    if (i + 1 == kSide) continue;
    F.row(2 * i) << 2 * i, 2 * i + 2, 2 * i + 1;
    F.row(2 * i + 1) << 2 * i + 2, 2 * i + 3, 2 * i + 1;
  }
  const VertexId wall = 2 * kSide;
  F.row(2 * (kSide - 1)) << wall, wall + 1, wall + 2;
  Positions V_t1 = V_t0;
  V_t1.rowwise() += Eigen::RowVector3d(40, 40, 40);
  V_t0.bottomRows(3) << 29, 19, 20, 31, 19, 20, 30, 22, 20.1;
  V_t1.bottomRows(3) = V_t0.bottomRows(3);
  const Mesh mesh = make_mesh(static_cast<VertexId>(V_t0.rows()), F);
  const Candidates swept = find_candidates_brute_force(mesh, V_t0, V_t1, {1e-6, {}});
  const Candidates moving = find_candidates_brute_force(mesh, V_t0, V_t1, {1e-6, {}, MotionBoxes::kMoving});
  ASSERT_GT(swept.vf.size() + swept.ee.size(), few_candidates(mesh));
  ASSERT_LT(4 * (moving.vf.size() + moving.ee.size()), few_candidates(mesh));
  const CollisionReport report = find(mesh, V_t0, V_t1, {1e-6, 4096});
  EXPECT_EQ(report.vf_candidates, std::ssize(moving.vf));
  EXPECT_EQ(report.ee_candidates, std::ssize(moving.ee));
  EXPECT_FALSE(report.collisions.empty());
  EXPECT_GT(report.toi_lower, 0.49);
  EXPECT_LT(report.toi_lower, 0.51);
}

TEST(FindCollisions, TheHostsFloatingPointEnvironmentHidesNone) {
  const auto found = [](const Mesh& mesh, const Positions& V_t0, const Positions& V_t1, double tolerance,
                        std::size_t most_listed, auto set_environment) {
    CollisionReport report;
    testing::in_host_environment(set_environment, [&] {
      BoxHierarchy hierarchy(mesh);
      report = find_collisions(mesh, hierarchy, V_t0, V_t1, {tolerance, 4096}, {}, {.most_listed = most_listed});
    });
    return report;
  };
  FaceAndVertex falls, rests;
  falls.V << -50, -50, -10, 50, -50, -10, 0, 90, -10, 0, 0, -1, -1, 0, 90, 1, 0, 90;
  Positions falls_t1 = falls.V;
  falls_t1(3, 2) = -20;
  constexpr double kLeast = std::numeric_limits<double>::denorm_min();
  const double near = std::numeric_limits<double>::min();
  rests.V << -1, -1, near, 1, -1, near, 0, 1, near, 0, 0, near + kLeast, -1, 0, 9, 1, 0, 9;
  for (const std::size_t most_listed : {CollisionLimits{}.most_listed, std::size_t{0}}) {
    const auto count = [&](auto set_environment) {
      const CollisionReport fall = found(falls.mesh, falls.V, falls_t1, 2, most_listed, set_environment);
      EXPECT_LT(fall.toi_lower, 0.5);
      const CollisionReport rest = found(rests.mesh, rests.V, rests.V, 2 * kLeast, most_listed, set_environment);
      return std::pair(fall.collisions.size(), rest.collisions.size());
    };
    const auto plain = count([] {});
    EXPECT_GT(plain.first, 0U);
    EXPECT_GT(plain.second, 0U);
    EXPECT_EQ(count([] { std::fesetround(FE_DOWNWARD); }), plain);
    EXPECT_EQ(count([] { std::fesetround(FE_UPWARD); }), plain);
    EXPECT_EQ(count([] { testing::set_fp_control(testing::fp_control() | testing::kFlushing); }), plain);
  }
}

TEST(FindCollisions, AVertexThroughItsOppositeEdgeIsASelfCollision) {
  Faces F(1, 3);
  F << 0, 1, 2;
  const Mesh mesh = make_mesh(3, F);
  Positions V_t0(3, 3), V_t1(3, 3);
  V_t0 << 0, 1, 0, -1, 0, 0, 1, 0, 0;
  V_t1 << 0, -1, 0, -1, 0, 0, 1, 0, 0;
  const CollisionReport report = find(mesh, V_t0, V_t1, {1e-6, 4096});
  ASSERT_EQ(report.collisions.size(), 1U);
  EXPECT_EQ(report.collisions[0].kind, PairKind::kSelf);
  EXPECT_EQ(report.collisions[0].first, 0);
  EXPECT_EQ(report.collisions[0].second, 0);
  EXPECT_LE(report.toi_lower, 0.5);
  EXPECT_GT(report.toi_lower, 0.499);
  V_t1 << 0, 0x1p-21, 0, -1, 0, 0, 1, 0, 0;  // no touch, but within tolerance at the end
  const CollisionReport near = find(mesh, V_t0, V_t1, {1e-6, 4096});
  ASSERT_EQ(near.collisions.size(), 1U);
  EXPECT_EQ(near.collisions[0].kind, PairKind::kSelf);
  EXPECT_EQ(near.collisions[0].ccd.cause, CcdCause::kEnd);
  BoxHierarchy hierarchy(mesh);
  EXPECT_TRUE(find_collisions(mesh, hierarchy, V_t0, V_t1, {}, std::vector<std::uint8_t>(3, 0)).collisions.empty());
}

}  // namespace selvage
