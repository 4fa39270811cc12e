#include "sim/bodies/one_place.h"

#include <array>
#include <cmath>
#include <initializer_list>
#include <vector>

#include <gtest/gtest.h>

namespace selvage::sim {
namespace {

Positions rows(std::initializer_list<std::array<double, 3>> places) {
  Positions x(std::ssize(places), 3);
  Eigen::Index row = 0;
  for (const auto& [a, b, c] : places) x.row(row++) << a, b, c;
  return x;
}

using Numbers = std::vector<VertexId>;

}  // namespace

TEST(OnePlace, NamesTheLowestVertexThere) {
  OnePlace place;
  place.narrow(rows({{1, 2, 3}, {0, 0, 0}, {1, 2, 3}, {1, 2, 3.5}, {0, 0, 0}, {1, 2, 3}}));
  EXPECT_EQ(place.first(), (Numbers{0, 1, 0, 3, 1, 0}));
}

TEST(OnePlace, MinusZeroIsZeroAndTheNextDoubleIsNot) {
  OnePlace place;
  const double next = std::nextafter(1.0, 2.0);
  place.narrow(rows({{0, -0.0, 1}, {-0.0, 0, 1}, {0, 0, next}}));
  EXPECT_EQ(place.first(), (Numbers{0, 0, 2}));
}

TEST(OnePlace, WhatPartsInAnyFrameIsNotOne) {
  OnePlace place;
  place.narrow(rows({{1, 1, 1}, {1, 1, 1}, {1, 1, 1}, {1, 1, 1}, {2, 2, 2}}));
  place.narrow(rows({{1, 1, 1}, {5, 5, 5}, {1, 1, 1}, {5, 5, 5}, {5, 5, 5}}));
  EXPECT_EQ(place.first(), (Numbers{0, 1, 0, 1, 4}));
  place.narrow(rows({{1, 1, 1}, {5, 5, 5}, {1, 1, 1}, {6, 5, 5}, {5, 5, 5}}));
  EXPECT_EQ(place.first(), (Numbers{0, 1, 0, 3, 4}));
  place.narrow(rows({{1, 1, 1}, {1, 1, 1}, {1, 1, 1}, {1, 1, 1}, {1, 1, 1}}));
  EXPECT_EQ(place.first(), (Numbers{0, 1, 0, 3, 4})) << "what met again has parted";
}

TEST(OnePlace, TwoPairsThatMeetStayTwo) {
  OnePlace place;
  place.narrow(rows({{1, 1, 1}, {5, 5, 5}, {1, 1, 1}, {5, 5, 5}}));
  place.narrow(rows({{2, 2, 2}, {2, 2, 2}, {2, 2, 2}, {2, 2, 2}}));
  EXPECT_EQ(place.first(), (Numbers{0, 1, 0, 1}));
}

TEST(OnePlace, NoVerticesHaveNone) {
  OnePlace place;
  place.narrow(Positions(0, 3));
  place.narrow(Positions(0, 3));
  EXPECT_TRUE(place.first().empty());
}

}  // namespace selvage::sim
