#include "sim/bodies/joined_faces.h"

#include <vector>

#include <gtest/gtest.h>

namespace selvage::sim {
namespace {

/// Of vertices of which those from 10 on lie where those from 0 on do.
JoinedFaces join(const io::Triangles& triangles) {
  std::vector<VertexId> first;
  for (VertexId v = 0; v < 30; ++v) first.push_back(v % 10);
  return join_faces(triangles, first);
}

}  // namespace

TEST(JoinedFaces, CornersHaveTheFirstNameAndFacesStayInOrder) {
  const JoinedFaces joined = join({{0, 1, 2}, {11, 3, 12}, {14, 5, 26}});
  EXPECT_EQ(joined.triangles, (io::Triangles{{0, 1, 2}, {1, 3, 2}, {4, 5, 6}}));
  EXPECT_EQ(joined.joined_vertices, 4);
  EXPECT_EQ(joined.left_out, 0);
}

TEST(JoinedFaces, ASegmentThatIsAnEdgeOfAFaceIsLeftOut) {
  const JoinedFaces joined = join({{0, 1, 10}, {0, 1, 2}, {12, 2, 1}, {0, 10, 20}});
  EXPECT_EQ(joined.triangles, (io::Triangles{{0, 1, 2}}));
  EXPECT_EQ(joined.left_out, 3);
  EXPECT_EQ(joined.joined_vertices, 3);
}

TEST(JoinedFaces, OneThatStandsAloneStays) {
  const JoinedFaces joined = join({{0, 1, 2}, {11, 5, 21}, {12, 3, 4}});
  EXPECT_EQ(joined.triangles, (io::Triangles{{0, 1, 2}, {1, 5, 21}, {2, 3, 4}})) << "it holds on to the surface";
  EXPECT_EQ(joined.left_out, 0);
}

TEST(JoinedFaces, OfSeveralThatStandAloneTogetherTheLastStays) {
  EXPECT_EQ(join({{0, 1, 10}, {1, 0, 11}, {0, 11, 21}}).triangles, (io::Triangles{{0, 1, 21}}));
  EXPECT_EQ(join({{0, 10, 20}, {10, 20, 0}}).triangles, (io::Triangles{{10, 20, 0}}));
  EXPECT_EQ(join({{0, 10, 20}, {10, 0, 5}}).triangles, (io::Triangles{{10, 0, 5}}))
      << "a point at the end of a segment";
}

TEST(JoinedFaces, ATwinOfAFaceIsAFace) {
  EXPECT_EQ(join({{0, 1, 2}, {12, 11, 10}}).triangles, (io::Triangles{{0, 1, 2}, {2, 1, 0}}));
}

}  // namespace selvage::sim
