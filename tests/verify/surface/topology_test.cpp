#include "verify/surface/topology.h"

#include <cstdint>
#include <limits>
#include <span>
#include <stdexcept>
#include <utility>

#include <gtest/gtest.h>
#include <sys/mman.h>

namespace selvage::verify {

TEST(Topology, EdgesAreNumberedByLargerThenSmallerVertex) {
  const std::vector<std::array<std::int32_t, 3>> triangles = {{4, 2, 3}, {0, 3, 2}};
  const Topology topology = make_topology({triangles, {}}, 6);
  const std::vector<std::array<std::int32_t, 2>> expected = {{0, 2}, {0, 3}, {2, 3}, {2, 4}, {3, 4}};
  EXPECT_EQ(topology.edges, expected);
  EXPECT_EQ(topology.unreferenced_vertices, 2);  // 1 and 5
  EXPECT_EQ(topology.vertices.cloth, (std::vector<std::int32_t>{0, 2, 3, 4}));
  EXPECT_EQ(topology.edge_parts.cloth, (std::vector<std::int32_t>{0, 1, 2, 3, 4}));
}

TEST(Topology, WhatAnyClothFaceHoldsIsCloth) {
  std::vector<std::array<std::int32_t, 3>> triangles = {{4, 2, 3}, {0, 3, 2}};
  std::vector<std::uint8_t> is_body = {1, 0};
  for (const std::int32_t body : {0, 1}) {  // the face of the body may be before that of the cloth, or behind it
    const Topology topology = make_topology({triangles, is_body}, 6);
    EXPECT_EQ(topology.faces.body, (std::vector<std::int32_t>{body}));
    EXPECT_EQ(topology.faces.cloth, (std::vector<std::int32_t>{1 - body}));
    EXPECT_EQ(topology.vertices.body, (std::vector<std::int32_t>{4}));
    EXPECT_EQ(topology.vertices.cloth, (std::vector<std::int32_t>{0, 2, 3}));
    EXPECT_EQ(topology.edge_parts.body, (std::vector<std::int32_t>{3, 4}));  // 2-4 and 3-4; 2-3 is shared
    std::swap(triangles[0], triangles[1]);
    std::swap(is_body[0], is_body[1]);
  }
}

TEST(Topology, RefusesWhatIsNoSurface) {
  const std::vector<std::array<std::int32_t, 3>> good = {{0, 1, 2}}, repeated = {{0, 1, 1}}, beyond = {{0, 1, 3}};
  const std::vector<std::uint8_t> two_flags = {0, 1};
  EXPECT_NO_THROW(static_cast<void>(make_topology({good, {}}, 3)));
  EXPECT_THROW(static_cast<void>(make_topology({repeated, {}}, 3)), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(make_topology({beyond, {}}, 3)), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(make_topology({good, two_flags}, 3)), std::invalid_argument);
  for (const FaceRange range : {FaceRange{-1, 1}, {0, 2}, {1, 0}}) {
    const std::vector<Exemption> exemptions{{{{0, 1}}, {range}}};
    EXPECT_THROW(static_cast<void>(make_topology({good, {}, {}, exemptions}, 3)), std::invalid_argument);
  }
  const std::vector<std::int32_t> foreign = {0, 1, 2, 2}, too_few = {0, 1, 2};
  const std::vector<std::array<std::int32_t, 3>> pair = {{0, 1, 2}, {2, 1, 3}};
  const std::vector<std::uint8_t> one_flag = {0};
  EXPECT_THROW(static_cast<void>(make_topology({pair, one_flag}, 4)), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(make_topology({pair, {}, one_flag}, 4)), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(make_topology({good, {}, two_flags}, 3)), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(make_topology({pair, {}, {}, {}, too_few}, 4)), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(make_topology({good, {}, {}, {}, foreign}, 3)), std::invalid_argument);
  const std::vector<std::array<std::int32_t, 3>> unnamed = {{0, 1, 3}};
  EXPECT_THROW(static_cast<void>(make_topology({unnamed, {}, {}, {}, foreign}, 4)), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(make_topology({good, {}, {}, {}, too_few}, 4)), std::invalid_argument);
}

TEST(Topology, RefusesMoreFacesThanEdgeNumbersWithoutReadingThem) {
  constexpr std::size_t kTooMany = std::numeric_limits<std::int32_t>::max() / 3 + 1;
  constexpr std::size_t kBytes = kTooMany * sizeof(std::array<std::int32_t, 3>);
  void* const unreadable = mmap(nullptr, kBytes, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  ASSERT_NE(unreadable, MAP_FAILED);
  const std::span faces(static_cast<const std::array<std::int32_t, 3>*>(unreadable), kTooMany);
  EXPECT_THROW(static_cast<void>(make_topology({faces, {}}, 3)), std::invalid_argument);
  munmap(unreadable, kBytes);
}

TEST(Topology, EdgesAndVerticesOfWeldedFacesAreThoseOfTheRepresentatives) {
  const std::vector<std::array<std::int32_t, 3>> triangles = {{0, 1, 2}, {2, 3, 4}, {5, 6, 7}};
  const std::vector<std::int32_t> representatives = {0, 1, 2, 2, 4, 5, 5, 5, 8};
  const Topology topology = make_topology({triangles, {}, {}, {}, representatives}, 9);
  const std::vector<std::array<std::int32_t, 2>> expected = {{0, 1}, {0, 2}, {1, 2}, {2, 4}};
  EXPECT_EQ(topology.edges, expected);
  EXPECT_EQ(topology.vertices.cloth, (std::vector<std::int32_t>{0, 1, 2, 4, 5}));
  EXPECT_EQ(topology.faces.cloth, (std::vector<std::int32_t>{0, 1, 2}));
  EXPECT_EQ(topology.unreferenced_vertices, 1) << "8; 3, 6 and 7 are others";
}

}  // namespace selvage::verify
