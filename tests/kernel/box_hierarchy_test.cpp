#include "kernel/box_hierarchy.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <functional>
#include <limits>
#include <mutex>
#include <thread>

#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include "tests/kernel/public_frames.h"
#include "tests/kernel/random_motion.h"
#include "tests/kernel/with_threads.h"
#include "tests/property.h"
#include "tests/vector_units.h"

namespace selvage {

namespace {

constexpr std::array kHierarchies = {HierarchyKind::kAutomatic, HierarchyKind::kSpatial, HierarchyKind::kTopology};

void expect_counts(const char* scene, const char* frame_t0, const char* frame_t1, std::size_t vf, std::size_t ee) {
  const auto frames = testing::public_frames(scene, frame_t0, frame_t1);
  if (!frames) GTEST_SKIP() << "the public frames of " << scene << " are not here (SELVAGE_DATA)";
  std::vector<Candidates> found;
  for (const HierarchyKind kind : kHierarchies) {
    BoxHierarchy hierarchy(frames->mesh, kind);
    hierarchy.refit(frames->V_t0, frames->V_t1, {});
    found.push_back(hierarchy.candidates());
    EXPECT_EQ(found.back().vf.size(), vf);
    EXPECT_EQ(found.back().ee.size(), ee);
  }
  EXPECT_EQ(found[0], found[1]);
  EXPECT_EQ(found[0], found[2]);
}

/// A sheet of n by n squares whose corners are at `V` = position(i, j).
template <typename Position>
std::pair<Mesh, Positions> sheet(VertexId n, const Position& position) {
  Faces F(2 * n * n, 3);
  Positions V((n + 1) * (n + 1), 3);
  for (VertexId i = 0; i <= n; ++i) {
    for (VertexId j = 0; j <= n; ++j) V.row(i * (n + 1) + j) = position(i, j);
  }
  for (VertexId i = 0; i < n; ++i) {
    for (VertexId j = 0; j < n; ++j) {
      const VertexId a = i * (n + 1) + j, b = a + n + 1;
      F.row(2 * (i * n + j)) << a, b, a + 1;
      F.row(2 * (i * n + j) + 1) << b + 1, a + 1, b;
    }
  }
  return {make_mesh(static_cast<VertexId>(V.rows()), F), V};
}

/// What is visited, put together; `work` is what the visitor does besides.
Candidates visited(
    const BoxHierarchy& hierarchy, const std::function<void()>& work = [] {}) {
  Candidates all;
  std::mutex mutex;
  hierarchy.visit_candidates([&](const Candidates& part) {
    {
      const std::scoped_lock lock(mutex);
      all.vf.insert(all.vf.end(), part.vf.begin(), part.vf.end());
      all.ee.insert(all.ee.end(), part.ee.begin(), part.ee.end());
    }
    work();
  });
  std::ranges::sort(all.vf);
  std::ranges::sort(all.ee);
  return all;
}

void expect_brute_force(const Mesh& mesh, const Positions& V_t0, const Positions& V_t1,
                        const CandidateOptions& options) {
  const Candidates expected = find_candidates_brute_force(mesh, V_t0, V_t1, options);
  for (const HierarchyKind kind : kHierarchies) {
    BoxHierarchy hierarchy(mesh, kind);
    hierarchy.refit(V_t0, V_t1, options);
    EXPECT_EQ(hierarchy.candidates(), expected);
    EXPECT_EQ(visited(hierarchy), expected);
    const std::size_t count = expected.vf.size() + expected.ee.size();
    EXPECT_EQ(hierarchy.candidates(count), expected);
    EXPECT_EQ(hierarchy.candidates(count - 1).has_value(), count == 0);  // below 0 is the largest number
  }
}

}  // namespace

/// K6 and K7: every hierarchy answers like brute force after every refit, with any number of threads. Positions change
/// so much between refits that the tree by position is made anew in most of them.
TEST(BoxHierarchy, PropEqualsBruteForce) {
  testing::check_property(2000, 6, [] {
    const auto shape = testing::random_shape();
    RC_LOG() << shape << '\n';
    const Mesh mesh = make_mesh(shape.vertex_count, shape.F);
    std::array hierarchies = {BoxHierarchy(mesh, kHierarchies[0]), BoxHierarchy(mesh, kHierarchies[1]),
                              BoxHierarchy(mesh, kHierarchies[2])};
    const int thread_count = *rc::gen::element(1, 2, 3, 8);
    const int refit_count = *rc::gen::inRange(1, 4);
    for (int refit = 0; refit < refit_count; ++refit) {
      const auto motion = testing::random_motion(shape.vertex_count);
      RC_LOG() << motion << '\n';
      const Candidates expected = find_candidates_brute_force(mesh, motion.V_t0, motion.V_t1, motion.options());
      for (BoxHierarchy& hierarchy : hierarchies) {
        Candidates found, in_parts;
        testing::with_threads(thread_count, [&] {
          hierarchy.refit(motion.V_t0, motion.V_t1, motion.options());
          found = hierarchy.candidates();
          in_parts = visited(hierarchy);
        });
        RC_ASSERT(found == expected);
        RC_ASSERT(in_parts == expected);
      }
    }
  });
}

/// The loops over boxes exist once for every kind of vector unit; all of them find the same pairs (K7).
TEST(BoxHierarchy, EveryVectorUnitFindsTheSamePairs) {
  const auto patch = sheet(13, [](VertexId i, VertexId j) { return Eigen::RowVector3d(i % 5, j % 4, i % 2); });
  const Mesh& mesh = patch.first;
  const Positions& V = patch.second;
  std::vector<std::uint8_t> active(static_cast<std::size_t>(mesh.vertex_count), 0);
  active[7] = active[90] = 1;
  testing::on_every_vector_unit([&](const char* unit) {
    SCOPED_TRACE(unit);
    expect_brute_force(mesh, V, -V, {});
    expect_brute_force(mesh, V, V, {0.5, active});
    expect_brute_force(mesh, V, V * 2, {0.5, {}, MotionBoxes::kMoving});
    expect_brute_force(mesh, V, -V, {0.5, active, MotionBoxes::kMoving});
  });
}

TEST(BoxHierarchy, AVisitorMayRunParallelCodeOfItsOwn) {
  const auto [mesh, V] = sheet(79, [](VertexId i, VertexId j) {  // in four layers
    return Eigen::RowVector3d(i % 20, j, 0.01 * (i / 20));
  });
  BoxHierarchy hierarchy(mesh);
  hierarchy.refit(V, V, {0.5, {}});
  const Candidates expected = hierarchy.candidates();
  // Some of what the visitor runs is slow in other threads, so that its own waits for it and looks for work.
  const auto work = [] {
    const auto visiting = std::this_thread::get_id();
    tbb::parallel_for(
        0, 32,
        [&](int) {
          const bool is_stolen = std::this_thread::get_id() != visiting;
          std::this_thread::sleep_for(std::chrono::microseconds(is_stolen ? 3000 : 50));
        },
        tbb::simple_partitioner());
  };
  testing::with_threads(8, [&] {
    for (int i = 0; i < 3; ++i) EXPECT_TRUE(visited(hierarchy, work) == expected);
  });
}

TEST(BoxHierarchy, MovesWithItsBoxes) {
  const auto [mesh, V] = sheet(4, [](VertexId i, VertexId j) { return Eigen::RowVector3d(i, j, 0); });
  const Candidates expected = find_candidates_brute_force(mesh, V, V, {});
  BoxHierarchy first(mesh);
  first.refit(V, V, {});
  BoxHierarchy second(std::move(first));
  EXPECT_EQ(second.candidates(), expected);
  BoxHierarchy third(mesh, HierarchyKind::kTopology);
  third = std::move(second);
  EXPECT_EQ(third.candidates(), expected);
}

TEST(BoxHierarchy, NoFacesAndOneFace) {
  const Positions none(0, 3), three = Positions::Random(3, 3);
  expect_brute_force(make_mesh(0, Faces(0, 3)), none, none, {});
  expect_brute_force(make_mesh(3, Faces(0, 3)), three, three, {});
  Faces F(1, 3);
  F << 2, 0, 1;
  expect_brute_force(make_mesh(3, F), three, -three, {});
}

/// Of 1058 faces each of the widest nodes has 132 or 133, and so both clusters, of 16 faces, and nodes, of 17, below
/// it.
TEST(BoxHierarchy, FitsMeshesOfItsSize) {
  Faces F(2, 3);
  F << 0, 1, 2, 1, 3, 2;
  const Mesh mesh = make_mesh(4, F);
  const BoxHierarchy hierarchy(mesh);
  EXPECT_TRUE(hierarchy.fits(mesh));
  Mesh other = mesh;
  ++other.vertex_count;
  EXPECT_FALSE(hierarchy.fits(other));
  other = mesh;
  other.edges.pop_back();
  EXPECT_FALSE(hierarchy.fits(other));
  other = mesh;
  other.faces.pop_back();
  EXPECT_FALSE(hierarchy.fits(other));
}

TEST(BoxHierarchy, ClustersOfDifferentDepths) {
  const auto [mesh, V] = sheet(23, [](VertexId i, VertexId j) { return Eigen::RowVector3d(i, j, i * j % 3); });
  ASSERT_EQ(mesh.faces.size(), 1058U);
  expect_brute_force(mesh, V, V, {});
  Positions mirrored = V;  // one half passes through the other, whose boxes it reaches at neither end
  for (Eigen::Index v = 0; v < V.rows(); ++v) {
    if (V(v, 0) > 12) mirrored(v, 0) = -V(v, 0);
  }
  for (const MotionBoxes boxes : {MotionBoxes::kSwept, MotionBoxes::kMoving}) {
    expect_brute_force(mesh, V, mirrored, {0, {}, boxes});
    expect_brute_force(mesh, mirrored, V, {0, {}, boxes});
  }
}

TEST(BoxHierarchy, AllVerticesCoincide) {
  const auto [mesh, V] = sheet(12, [](VertexId, VertexId) { return Eigen::RowVector3d(1, 2, 3); });
  expect_brute_force(mesh, V, V, {});
  Positions away = V;
  away.row(5) << -1, 0, 7;
  expect_brute_force(mesh, V, away, {});
}

TEST(BoxHierarchy, TheLargestAndTheSmallestCoordinates) {
  for (const double scale : {kMaxCoordinate / 13, 0x1p-1074}) {
    const auto [mesh, V] = sheet(13, [scale](VertexId i, VertexId j) {
      return Eigen::RowVector3d(scale * (i % 5), scale * (j % 4), i % 2 == 0 ? -13 * scale : 13 * scale);
    });
    expect_brute_force(mesh, V, -V, {});
    expect_brute_force(mesh, V, V, {scale, {}});
  }
}

/// Far outside the domain nothing is promised but that the program goes on.
TEST(BoxHierarchy, SurvivesPositionsOutsideTheDomain) {
  auto [mesh, V] = sheet(20, [](VertexId i, VertexId j) { return Eigen::RowVector3d(i, j, i * j % 7); });
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (Eigen::Index v = 0; v < V.rows(); v += 3) V(v, v % 2) = v % 4 == 0 ? std::nan("") : kInfinity;
  BoxHierarchy hierarchy(mesh);
  hierarchy.refit(V, -V, {});
  EXPECT_FALSE(hierarchy.candidates().ee.empty());
}

TEST(BoxHierarchy, ClothBallHasThePublishedNumberOfCandidates) {
  expect_counts("cloth-ball", "cloth_ball92.ply", "cloth_ball93.ply", 1'655'541, 5'197'332);
}

TEST(BoxHierarchy, RodTwistHasThePublishedNumberOfCandidates) {
  expect_counts("rod-twist", "3036.ply", "3037.ply", 448'270, 2'041'334);
}

}  // namespace selvage
