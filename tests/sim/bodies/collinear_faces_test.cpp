#include "sim/bodies/collinear_faces.h"

#include <gtest/gtest.h>

namespace selvage::sim {
namespace {

/// Vertices 0 to 4 on the x axis, a unit apart; 5 above, 6 below them.
Positions places(double off_the_axis = 0) {
  Positions x(7, 3);
  x << 0, 0, 0, 1, 0, 0, 2, off_the_axis, 0, 3, 0, 0, 4, 0, 0, 2, 3, 0, 2, -3, 0;
  return x;
}

io::Triangles split(const io::Triangles& triangles, double off_the_axis = 0) {
  return split_at_collinear_corners(triangles, places(off_the_axis)).triangles;
}

}  // namespace

TEST(CollinearFaces, TheFaceBeyondIsSplit) {
  // A polygon 0, 2, 4, 5 as a fan, and what is on the other side of its side.
  const SplitFaces faces = split_at_collinear_corners({{0, 2, 4}, {0, 4, 5}, {2, 0, 6}, {4, 2, 6}}, places());
  EXPECT_EQ(faces.triangles, (io::Triangles{{0, 2, 5}, {2, 4, 5}, {2, 0, 6}, {4, 2, 6}}));
  EXPECT_EQ(faces.resolved, 1);
}

TEST(CollinearFaces, OneAfterTheOtherOfAFan) {
  EXPECT_EQ(split({{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}}),
            (io::Triangles{{0, 1, 5}, {1, 2, 5}, {2, 3, 5}, {3, 4, 5}}));
  EXPECT_EQ(split({{4, 2, 3}, {4, 1, 2}, {4, 0, 1}, {0, 4, 5}}).size(), 4u);
}

TEST(CollinearFaces, AllFacesBeyondAreSplit) {
  EXPECT_EQ(split({{0, 4, 5}, {4, 0, 6}, {0, 3, 4}}), (io::Triangles{{3, 4, 5}, {4, 3, 6}, {0, 3, 5}, {3, 0, 6}}));
}

TEST(CollinearFaces, WhatRunsAlongOthersIsLeftOut) {
  EXPECT_EQ(split({{0, 2, 4}, {0, 2, 5}, {2, 4, 5}}), (io::Triangles{{0, 2, 5}, {2, 4, 5}}));
  EXPECT_EQ(split({{0, 2, 4}, {2, 4, 0}, {0, 2, 5}, {2, 4, 5}}), (io::Triangles{{0, 2, 5}, {2, 4, 5}})) << "a twin";
}

TEST(CollinearFaces, WhatStandsAloneStays) {
  for (const io::Triangles& alone : {io::Triangles{{0, 2, 4}}, io::Triangles{{0, 2, 4}, {0, 2, 5}}}) {
    EXPECT_EQ(split(alone), alone);
  }
  EXPECT_EQ(split({{0, 2, 4}, {4, 0, 2}}).size(), 1u);
  EXPECT_EQ(split({{0, 1, 4}, {0, 3, 4}}).size(), 2u) << "each is all there is beyond the other";
}

TEST(CollinearFaces, AMillionthOfTheLongestEdgeIsNoHeight) {
  const io::Triangles polygon{{0, 2, 4}, {0, 4, 5}};
  EXPECT_NE(split(polygon, 3.9e-6), polygon);
  EXPECT_EQ(split(polygon, 4.1e-6), polygon);
}

}  // namespace selvage::sim
