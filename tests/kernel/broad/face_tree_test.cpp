#include "kernel/broad/face_tree.h"

#include <cmath>

#include <gtest/gtest.h>

#include "kernel/broad/spatial_face_tree.h"
#include "tests/kernel/random_motion.h"
#include "tests/kernel/with_threads.h"
#include "tests/property.h"

namespace selvage {

namespace {

/// Depth of the root's deepest face; -1 if a node has no parent or several.
int depth_of(const FaceTree& tree, std::size_t face_count) {
  std::vector<int> depth(face_count + tree.children.size(), -1);
  if (depth.empty()) return 0;
  depth.back() = 0;
  int deepest = 0;
  for (std::size_t i = tree.children.size(); i-- > 0;) {
    for (const std::int32_t child : tree.children[i]) {
      int& depth_below = depth[static_cast<std::size_t>(child)];
      if (depth_below >= 0 || depth[face_count + i] < 0) return -1;
      depth_below = depth[face_count + i] + 1;
      deepest = std::max(deepest, depth_below);
    }
  }
  return std::count(depth.begin(), depth.end(), -1) > 0 ? -1 : deepest;
}

/// Every sweep leaves at most 3/4 of its nodes plus one: 2.41 log2(n) sweeps down to four nodes, and a few more.
int depth_bound(std::size_t face_count) {
  return static_cast<int>(std::ceil(2.41 * std::log2(static_cast<double>(face_count) + 1))) + 4;
}

/// A strip of n quads along x; every face on the upper side carries a chain of `spike` faces.
Mesh comb(int n, int spike) {
  std::vector<std::array<VertexId, 3>> faces;
  VertexId next = 2;
  VertexId lower = 0, upper = 1;
  for (int i = 0; i < n; ++i) {
    const VertexId next_lower = next++, next_upper = next++;
    faces.push_back({lower, next_lower, upper});
    faces.push_back({next_lower, next_upper, upper});
    VertexId a = upper, b = next_upper;
    for (int k = 0; k < spike; ++k) {
      faces.push_back({a, b, next});
      a = b;
      b = next++;
    }
    lower = next_lower;
    upper = next_upper;
  }
  return make_mesh(next, faces);
}

}  // namespace

TEST(FaceTree, PropHoldsEveryFaceOnceAndIsShallow) {
  testing::check_property(300, 3, [] {
    const auto shape = testing::random_shape();
    RC_LOG() << shape << '\n';
    const Mesh mesh = make_mesh(shape.vertex_count, shape.F);
    const FaceTree tree = make_face_tree(mesh);
    const std::size_t face_count = mesh.faces.size();
    RC_ASSERT(tree.children.size() == (face_count == 0 ? 0 : face_count - 1));
    const int depth = depth_of(tree, face_count);
    RC_ASSERT(depth >= 0);
    RC_ASSERT(depth <= depth_bound(face_count));
  });
}

/// Shapes whose adjacency is a star, a clique, a path or nothing at all: greedy pairing alone would leave a chain of
/// thousands of nodes for the first, and a list of pairs that is quadratic in length for the second.
TEST(FaceTree, IsShallowForDegenerateAdjacency) {
  constexpr VertexId kCount = 20000;
  std::vector<std::array<VertexId, 3>> book, pages, loose;
  for (VertexId i = 0; i < kCount; ++i) {
    book.push_back({0, 1, 2 + i});                   // all faces around one edge
    pages.push_back({i % 2, 2, 3 + i});              // two books with a common cover
    loose.push_back({3 * i, 3 * i + 1, 3 * i + 2});  // components of one face
  }
  pages.push_back({0, 1, 2});
  for (const Mesh& mesh : {make_mesh(kCount + 2, book), make_mesh(kCount + 3, pages), make_mesh(3 * kCount, loose),
                           comb(kCount, 1), comb(kCount / 10, 9)}) {
    const int depth = depth_of(make_face_tree(mesh), mesh.faces.size());
    EXPECT_GE(depth, 0);
    EXPECT_LE(depth, depth_bound(mesh.faces.size()));
  }
}

/// Halving bounds the depth whatever the positions are: log2 of the leaves, four levels in a leaf, and rounding.
TEST(SpatialFaceTree, PropHoldsEveryFaceOnceAndIsShallow) {
  testing::check_property(300, 4, [] {
    const auto shape = testing::random_shape();
    const auto motion = testing::random_motion(shape.vertex_count);
    RC_LOG() << shape << '\n' << motion << '\n';
    const Mesh mesh = make_mesh(shape.vertex_count, shape.F);
    const FaceTree tree = make_spatial_face_tree(mesh, motion.V_t0, motion.V_t1);
    const std::size_t face_count = mesh.faces.size();
    RC_ASSERT(tree.children.size() == (face_count == 0 ? 0 : face_count - 1));
    const int depth = depth_of(tree, face_count);
    RC_ASSERT(depth >= 0);
    RC_ASSERT(depth <= static_cast<int>(std::log2(static_cast<double>(face_count) + 1)) + 2);
  });
}

/// Large enough for several tasks.
TEST(SpatialFaceTree, IsTheSameForAnyThreadCount) {
  const Mesh mesh = comb(8000, 2);
  Positions V(mesh.vertex_count, 3);
  for (std::int64_t v = 0; v < mesh.vertex_count; ++v) {
    V.row(v) = Eigen::Vector3<std::int64_t>((v * 7919) % 1013, (v * 104729) % 4801, v % 5).cast<double>();
  }
  const FaceTree tree = make_spatial_face_tree(mesh, V, V);
  EXPECT_LE(depth_of(tree, mesh.faces.size()), std::log2(static_cast<double>(mesh.faces.size())) + 2);
  for (const int count : {1, 2, 3, 8}) {
    testing::with_threads(count, [&] { EXPECT_EQ(make_spatial_face_tree(mesh, V, V).children, tree.children); });
  }
}

}  // namespace selvage
