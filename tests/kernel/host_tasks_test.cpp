// A host may call the kernel from within tasks of its own: what it does with these changes nothing.
#include "tests/host_tasks.h"

#include <array>
#include <atomic>

#include <gtest/gtest.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include "kernel/kernel.h"
#include "tests/kernel/with_threads.h"

namespace selvage {
namespace {

/// Two layers of n by n squares, which pass through each other.
struct Layers {
  explicit Layers(VertexId n) : V_t0(2 * (n + 1) * (n + 1), 3), V_t1(V_t0.rows(), 3) {
    std::vector<std::array<VertexId, 3>> triangles;
    for (VertexId layer = 0; layer < 2; ++layer) {
      for (VertexId i = 0; i <= n; ++i) {
        for (VertexId j = 0; j <= n; ++j) {
          const VertexId a = (layer * (n + 1) + i) * (n + 1) + j, b = a + n + 1;
          V_t0.row(a) << i + 0.3 * layer, j + 0.2 * layer, layer;
          V_t1.row(a) << i + 0.3 * layer, j + 0.2 * layer, 0.5 - 0.5 * layer;
          if (i == n || j == n) continue;
          triangles.push_back({a, b, a + 1});
          triangles.push_back({b + 1, a + 1, b});
        }
      }
    }
    mesh = make_mesh(static_cast<VertexId>(V_t0.rows()), triangles);
  }
  Positions V_t0, V_t1;
  Mesh mesh;
};

bool operator==(const CollisionReport& a, const CollisionReport& b) {
  const auto same = [](const Collision& c, const Collision& d) {
    return c.kind == d.kind && c.first == d.first && c.second == d.second && c.ccd.toi_lower == d.ccd.toi_lower;
  };
  return std::ranges::equal(a.collisions, b.collisions, same) && a.toi_lower == b.toi_lower;
}

}  // namespace

TEST(HostTasks, ThatAreCancelledLoseNoPair) {
  const Layers layers(40);
  for (const HierarchyKind kind : {HierarchyKind::kTopology, HierarchyKind::kSpatial}) {
    const auto found = [&] {
      BoxHierarchy hierarchy(layers.mesh, kind);
      hierarchy.refit(layers.V_t0, layers.V_t1, {});
      return hierarchy.candidates();
    };
    const Candidates expected = found();
    ASSERT_GT(expected.ee.size(), 1000U);
    EXPECT_TRUE(testing::in_cancelled_task(found) == expected);
  }
  const auto collisions = [&] {
    BoxHierarchy hierarchy(layers.mesh);
    return find_collisions(layers.mesh, hierarchy, layers.V_t0, layers.V_t1, {});
  };
  const CollisionReport expected = collisions();
  ASSERT_GT(expected.collisions.size(), 1000U);
  EXPECT_TRUE(testing::in_cancelled_task(collisions) == expected);
  const auto proximities = [&] {
    BoxHierarchy hierarchy(layers.mesh);
    return find_proximities(layers.mesh, hierarchy, layers.V_t0, 1.5).size();
  };
  ASSERT_GT(proximities(), 1000U);
  EXPECT_EQ(testing::in_cancelled_task(proximities), proximities());
}

TEST(HostTasks, ThatAreCancelledCutNoVisitorShort) {
  const Layers layers(40);
  BoxHierarchy hierarchy(layers.mesh);
  hierarchy.refit(layers.V_t0, layers.V_t1, {});
  std::atomic<int> visits = 0, done = 0;
  const auto visit = [&](const Candidates&) {
    ++visits;
    tbb::parallel_for(0, 64, [&](int) { ++done; });
  };
  (void)testing::in_cancelled_task([&] {
    hierarchy.visit_candidates(visit);
    return true;
  });
  EXPECT_GT(visits, 1);
  EXPECT_EQ(done, 64 * visits);
}

/// While a thread waits for the end of a search, oneTBB could give it the host's next task, which may use what that
/// thread is using: a hierarchy for each thread is the usual way.
TEST(HostTasks, AreNotBegunWithinACallOfTheSameThread) {
  const Layers layers(40);
  BoxHierarchy hierarchy(layers.mesh);
  hierarchy.refit(layers.V_t0, layers.V_t1, {});
  std::atomic<int> calls = 0, within = 0;
  testing::with_threads(8, [&] {
    tbb::enumerable_thread_specific<int> depth(0);
    tbb::parallel_for(
        0, 64,
        [&](int) {
          int& own = depth.local();
          if (own > 0) ++within;
          ++own;
          (void)hierarchy.candidates();
          ++calls;
          --own;
        },
        tbb::simple_partitioner());
  });
  EXPECT_EQ(calls, 64);
  EXPECT_EQ(within, 0);
}

}  // namespace selvage
