#include "kernel/proximities.h"

#include <algorithm>
#include <cfenv>
#include <random>
#include <tuple>
#include <utility>

#include <gtest/gtest.h>

#include "kernel/collisions.h"
#include "tests/host_environment.h"
#include "tests/kernel/random_motion.h"
#include "tests/kernel/with_threads.h"
#include "tests/property.h"

namespace selvage {

namespace {

std::array<Vec3, 4> points(const PositionsRef& V, const std::array<VertexId, 4>& vertices) {
  return {V.row(vertices[0]), V.row(vertices[1]), V.row(vertices[2]), V.row(vertices[3])};
}

}  // namespace

/// Exactly the pairs with distance_lower < reach, whether or not their boxes are asked; nothing nearer is left out.
TEST(FindProximities, PropFindsEveryPairNearerThanReach) {
  testing::check_property(150, 9, [] {
    const auto shape = testing::random_shape();
    const auto motion = testing::random_motion(shape.vertex_count);
    RC_LOG() << shape << '\n' << motion << '\n';
    const Mesh mesh = make_mesh(shape.vertex_count, shape.F);
    BoxHierarchy hierarchy(mesh);
    std::vector<PairProximity> found;
    testing::with_threads(*rc::gen::element(1, 2, 3, 8),
                          [&] { found = find_proximities(mesh, hierarchy, motion.V_t0, motion.reach, motion.active); });
    // All pairs there are: those whose boxes overlap when grown beyond the domain.
    const CandidateOptions everything = {8 * kMaxCoordinate, motion.active};
    const Candidates all = find_candidates_brute_force(mesh, motion.V_t0, motion.V_t0, everything);
    std::size_t next = 0;
    const auto check = [&](PairKind kind, std::int32_t first, std::int32_t second, auto query) {
      const auto vertices = pair_vertices(mesh, kind, first, second);
      const Proximity expected = query(points(motion.V_t0, vertices));
      const bool listed =
          next < found.size() && found[next].kind == kind && found[next].first == first && found[next].second == second;
      if (!listed) {
        RC_ASSERT(expected.distance_upper >= motion.reach);
        return;
      }
      const PairProximity& pair = found[next++];
      RC_ASSERT(expected.distance_lower < motion.reach);
      RC_ASSERT(pair.vertices == vertices);
      RC_ASSERT(pair.proximity.weights == expected.weights);
      RC_ASSERT(pair.proximity.distance == expected.distance);
      RC_ASSERT(pair.proximity.distance_lower == expected.distance_lower);
    };
    for (const auto& [v, f] : all.vf) check(PairKind::kVf, v, f, vf_proximity);
    for (const auto& [a, b] : all.ee) check(PairKind::kEe, a, b, ee_proximity);
    RC_ASSERT(next == found.size());
    // The first half leaves nothing out that the second would keep.
    const Candidates near = find_near_candidates(mesh, hierarchy, motion.V_t0, motion.reach, motion.active);
    for (const PairProximity& pair : found) {
      const bool is_left = pair.kind == PairKind::kVf
                               ? std::ranges::binary_search(near.vf, VfCandidate{pair.first, pair.second})
                               : std::ranges::binary_search(near.ee, EeCandidate{pair.first, pair.second});
      RC_ASSERT(is_left);
    }
  });
}

TEST(FindProximities, TheHostsFloatingPointEnvironmentChangesNothing) {
  constexpr std::int32_t kFaceCount = 20;
  Faces F(kFaceCount, 3);
  for (std::int32_t f = 0; f < kFaceCount; ++f) F.row(f) << 3 * f, 3 * f + 1, 3 * f + 2;
  const Mesh mesh = make_mesh(3 * kFaceCount, F);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> coordinate(-1, 1);
  for (int repeat = 0; repeat < 100; ++repeat) {
    Positions V(3 * kFaceCount, 3);
    for (double& x : V.reshaped()) x = coordinate(random);
    BoxHierarchy hierarchy(mesh);
    const auto all = find_proximities(mesh, hierarchy, V, 1);
    ASSERT_FALSE(all.empty());
    // So near the distance of a pair that the last bit of a float32 decides.
    const double reach = all[all.size() / 2].proximity.distance * (1 - 6e-7);
    const auto found = [&](auto set_environment) {
      std::pair<Candidates, std::size_t> result;
      testing::in_host_environment(set_environment, [&] {
        result = {find_near_candidates(mesh, hierarchy, V, reach), find_proximities(mesh, hierarchy, V, reach).size()};
      });
      return result;
    };
    const auto plain = found([] {});
    EXPECT_EQ(found([] { std::fesetround(FE_DOWNWARD); }), plain);
    EXPECT_EQ(found([] { std::fesetround(FE_UPWARD); }), plain);
  }
}

/// More candidates than one task takes: nothing is lost or doubled where one ends and the next begins.
TEST(FindProximities, AnswersEveryCandidateOfManyTasks) {
  constexpr std::int32_t kSide = 24;
  Positions V(2 * kSide * kSide, 3);
  Faces F(4 * (kSide - 1) * (kSide - 1), 3);
  std::int32_t face = 0;
  for (std::int32_t layer = 0; layer < 2; ++layer) {
    const auto vertex = [layer](std::int32_t i, std::int32_t j) { return (layer * kSide + i) * kSide + j; };
    for (std::int32_t i = 0; i < kSide; ++i) {
      for (std::int32_t j = 0; j < kSide; ++j) {
        V.row(vertex(i, j)) << i + 0.3 * layer, j + 0.2 * layer, 0.5 * layer + 0.01 * ((7 * i + 3 * j) % 5);
        if (i + 1 == kSide || j + 1 == kSide) continue;
        F.row(face++) << vertex(i, j), vertex(i + 1, j), vertex(i, j + 1);
        F.row(face++) << vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1);
      }
    }
  }
  const Mesh mesh = make_mesh(2 * kSide * kSide, F);
  BoxHierarchy hierarchy(mesh);
  constexpr double kReach = 1;
  hierarchy.refit(V, V, {kReach, {}});
  const Candidates all = hierarchy.candidates();
  ASSERT_GT(all.vf.size(), 2 * 4096U);
  ASSERT_GT(all.ee.size(), 2 * 4096U);
  using Name = std::tuple<PairKind, std::int32_t, std::int32_t>;
  std::vector<Name> expected, found;
  const auto expect = [&](PairKind kind, std::int32_t first, std::int32_t second, auto query) {
    const auto x = points(V, pair_vertices(mesh, kind, first, second));
    if (query(x).distance_lower < kReach) expected.emplace_back(kind, first, second);
  };
  for (const auto& [v, f] : all.vf) expect(PairKind::kVf, v, f, vf_proximity);
  for (const auto& [a, b] : all.ee) expect(PairKind::kEe, a, b, ee_proximity);
  for (const PairProximity& pair : find_proximities(mesh, hierarchy, V, kReach)) {
    found.emplace_back(pair.kind, pair.first, pair.second);
  }
  ASSERT_GT(expected.size(), 2 * 4096U);
  EXPECT_EQ(found, expected);
}

}  // namespace selvage
