// The definition of a candidate, on cases small enough to be answered by hand.
#include <cmath>

#include <gtest/gtest.h>

#include "kernel/candidates.h"

namespace selvage {

namespace {

/// Two triangles of legs 1 in parallel planes `gap` apart: vertices 0-2 below, 3-5 above, 6 loose and on the first.
struct TwoTriangles {
  Mesh mesh;
  Positions V;
  explicit TwoTriangles(double gap) : V(7, 3) {
    Faces F(2, 3);
    F << 0, 1, 2, 3, 4, 5;
    mesh = make_mesh(7, F);
    V << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, gap, 1, 0, gap, 0, 1, gap, 0, 0, 0;
  }
  [[nodiscard]] Candidates find(const CandidateOptions& options) const {
    return find_candidates_brute_force(mesh, V, V, options);
  }
};

/// Every vertex with the other face, every edge with the three of the other triangle.
const Candidates kAll = {{{0, 1}, {1, 1}, {2, 1}, {3, 0}, {4, 0}, {5, 0}},
                         {{0, 3}, {0, 4}, {0, 5}, {1, 3}, {1, 4}, {1, 5}, {2, 3}, {2, 4}, {2, 5}}};

}  // namespace

TEST(BruteForce, TouchingBoxesAreCandidates) {
  // All boxes lie in the plane: those of the legs are segments that meet those of the other leg in a corner only.
  EXPECT_EQ(TwoTriangles(0).find({}), kAll);
}

TEST(BruteForce, AnUlpApartIsApart) {
  const TwoTriangles apart(0x1p-1074);
  EXPECT_EQ(apart.find({}), Candidates{});
  EXPECT_EQ(apart.find({0x1p-1074, {}}), kAll);
}

TEST(BruteForce, ReachIsTheDistanceThatCounts) {
  const TwoTriangles apart(0.25);
  EXPECT_EQ(apart.find({0.25, {}}), kAll);
  EXPECT_EQ(apart.find({0.2499, {}}), Candidates{});
}

TEST(BruteForce, TheWholePathCounts) {
  const TwoTriangles below(-1), above(1), apart(5);
  const CandidateOptions options;
  EXPECT_EQ(find_candidates_brute_force(above.mesh, above.V, below.V, options), kAll);
  EXPECT_EQ(find_candidates_brute_force(above.mesh, above.V, apart.V, options), Candidates{});
}

TEST(BruteForce, PairsNeedAnActiveVertex) {
  const TwoTriangles touching(0);
  std::vector<std::uint8_t> active(7, 0);
  EXPECT_EQ(touching.find({0, active}), Candidates{});
  active[6] = 1;  // loose: part of no pair
  EXPECT_EQ(touching.find({0, active}), Candidates{});
  active[0] = 1;  // face 0; edges {0,1} = 0 and {0,2} = 1
  const Candidates with_vertex_0 = {{{0, 1}, {3, 0}, {4, 0}, {5, 0}}, {{0, 3}, {0, 4}, {0, 5}, {1, 3}, {1, 4}, {1, 5}}};
  EXPECT_EQ(touching.find({0, active}), with_vertex_0);
}

TEST(BruteForce, FeaturesThatShareAVertexAreNoPair) {
  Faces F(2, 3);
  F << 0, 1, 2, 2, 1, 3;
  const Mesh mesh = make_mesh(4, F);
  const Positions V = Positions::Zero(4, 3);
  const Candidates expected = {{{0, 1}, {3, 0}}, {{0, 4}, {1, 3}}};  // edges 01, 02, 12, 13, 23
  EXPECT_EQ(find_candidates_brute_force(mesh, V, V, {}), expected);
}

TEST(Candidates, DifferIfAnyPairDiffers) {
  Candidates other = kAll;
  other.ee.pop_back();
  EXPECT_NE(other, kAll);
  other = kAll;
  other.vf.front().face = 7;
  EXPECT_NE(other, kAll);
}

}  // namespace selvage
