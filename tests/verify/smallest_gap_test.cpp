// The smallest gap of a frame, against all pairs.
#include "verify/smallest_gap.h"

#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "tests/verify/sheet.h"
#include "verify/decision/exact_distance.h"

namespace selvage::verify {
namespace {

using selvage::testing::sheet;

/// Whether some pair is closer than d, or within d.
struct Nearest {
  bool closer = false, within = false;
};
Nearest nearest(const Topology& topology, const std::vector<Point>& V, double d) {
  Nearest found;
  const auto at = [&](std::int32_t v) { return V[static_cast<std::size_t>(v)]; };
  const auto note = [&](int sign) {
    found.closer = found.closer || sign < 0;
    found.within = found.within || sign <= 0;
  };
  for (const std::int32_t v : topology.vertices.cloth) {
    for (const auto& [a, b, c] : topology.triangles) {
      if (v != a && v != b && v != c) note(compare_vf_distance({at(v), at(a), at(b), at(c)}, d));
    }
  }
  for (const auto& [a, b] : topology.edges) {
    for (const auto& [c, d2] : topology.edges) {
      if (a != c && a != d2 && b != c && b != d2) note(compare_ee_distance({at(a), at(b), at(c), at(d2)}, d));
    }
  }
  return found;
}

void expect_smallest(const io::MeshData& mesh, const char* why) {
  const Topology topology = make_topology({mesh.triangles}, mesh.points.size());
  const std::optional<Gap> gap = smallest_gap(topology, mesh.points, {});
  ASSERT_TRUE(gap) << why;
  const Nearest upper = nearest(topology, mesh.points, gap->upper), lower = nearest(topology, mesh.points, gap->lower);
  EXPECT_TRUE(upper.within) << why << " " << gap->upper;
  EXPECT_FALSE(lower.closer) << why << " " << gap->lower;
  if (gap->lower < gap->upper) {
    EXPECT_EQ(std::nextafter(gap->lower, std::numeric_limits<double>::infinity()), gap->upper) << why;
    EXPECT_TRUE(upper.closer) << why;
    EXPECT_FALSE(lower.within) << why;
  } else {
    EXPECT_FALSE(upper.closer) << why;
  }
}

}  // namespace

TEST(SmallestGap, IsThatOfAllPairs) {
  std::mt19937 random(3);
  for (int round = 0; round < 12; ++round) {
    io::MeshData mesh = sheet(4);
    const double scale = std::ldexp(1.0, 40 * (round % 5) - 80);
    for (Point& p : mesh.points) {
      for (double& x : p) x = (x + std::ldexp(static_cast<double>(random() % 1024), -12)) * scale;
    }
    const io::MeshData below = mesh;
    const auto offset = static_cast<std::int32_t>(mesh.points.size());
    for (Point p : below.points) {
      p[2] += std::ldexp(scale, -round);
      mesh.points.push_back(p);
    }
    for (const auto& [a, b, c] : below.triangles) mesh.triangles.push_back({a + offset, b + offset, c + offset});
    expect_smallest(mesh, ("round " + std::to_string(round)).c_str());
  }
}

TEST(SmallestGap, OfWhatIsFarApartOrTouches) {
  io::MeshData mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.25, 0.25, 1e6}, {1, 0, 1e6}, {0, 1, 1e6}};
  mesh.triangles = {{0, 1, 2}, {3, 4, 5}};
  expect_smallest(mesh, "no boxes overlap");
  for (std::size_t i = 3; i < 6; ++i) mesh.points[i][2] = 0x1p-1074;
  expect_smallest(mesh, "the smallest double");
  EXPECT_EQ(smallest_gap(make_topology({mesh.triangles}, 6), mesh.points, {})->upper, 0x1p-1074);
  mesh.points[3][2] = 0;
  EXPECT_EQ(smallest_gap(make_topology({mesh.triangles}, 6), mesh.points, {})->upper, 0);
  for (std::size_t i = 3; i < 6; ++i) mesh.points[i][2] = 0x1p+1000;
  expect_smallest(mesh, "huge");
}

// Ties of the rounded distances were broken by name: 1 was reported, as an exact distance, where another pair is
// nearer.
TEST(SmallestGap, IsOfANearestPairWhateverTheOrder) {
  const std::vector<Point> one = testing::two_faces_apart(1, 0, 0),
                           less = testing::two_faces_apart(1 - 0x1p-53, 0x1p-27, 100);
  for (const bool less_first : {false, true}) {
    io::MeshData mesh;
    mesh.points = less_first ? less : one;
    const std::vector<Point>& second = less_first ? one : less;
    mesh.points.insert(mesh.points.end(), second.begin(), second.end());
    for (std::int32_t v = 0; v < 12; v += 3) mesh.triangles.push_back({v, v + 1, v + 2});
    expect_smallest(mesh, less_first ? "the nearest pair first" : "the nearest pair last");
    const std::optional<Gap> gap = smallest_gap(make_topology({mesh.triangles}, 12), mesh.points, {});
    ASSERT_EQ(gap->x.size(), 4U);
    EXPECT_EQ(gap->x[0][1], 100);
  }
}

// Reports of earlier versions do not hold the vertices.
TEST(SmallestGap, WithoutItsVerticesIsToldByItsBounds) {
  const Gap exact{1, 1}, less{1 - 0x1p-53, 1};
  EXPECT_TRUE(is_smaller(less, exact));
  EXPECT_FALSE(is_smaller(exact, less));
  EXPECT_FALSE(is_smaller(less, less)) << "of which nobody knows";
}

TEST(SmallestGap, OfSubnormalMeshes) {
  std::mt19937 random(5);
  for (int round = 0; round < 300; ++round) {
    io::MeshData mesh;
    const int extent = 2 + round % 7;
    for (int v = 0; v < 9; ++v) {
      Point p;
      for (double& x : p) x = static_cast<double>(static_cast<int>(random()) % extent) * 0x1p-1074;
      mesh.points.push_back(p);
    }
    mesh.triangles = {{0, 1, 2}, {3, 4, 5}, {6, 7, 8}};
    expect_smallest(mesh, ("round " + std::to_string(round)).c_str());
  }
}

TEST(SmallestGap, IsOfPairsThatAreChecked) {
  io::MeshData mesh = sheet(3);
  const Topology single = make_topology({std::span(mesh.triangles).first(1)}, mesh.points.size());
  EXPECT_FALSE(smallest_gap(single, mesh.points, {})) << "one face has no pair";
  const double alone = smallest_gap(make_topology({mesh.triangles}, 16), mesh.points, {})->upper;
  const auto p = testing::add_vertex(mesh, testing::point_on(mesh, 4, {1, 1, 2}, 0x1p-10)),
             q = testing::add_vertex(mesh, {1, 1, 9}), r = testing::add_vertex(mesh, {2, 1, 9});
  mesh.triangles.push_back({p, q, r});
  EXPECT_LE(smallest_gap(make_topology({mesh.triangles}, 19), mesh.points, {})->upper, 0x1p-10);
  const std::vector<Exemption> exempt = {{{{0, 18}}, {{18, 19}}}};
  EXPECT_EQ(smallest_gap(make_topology({mesh.triangles, {}, {}, exempt}, 19), mesh.points, {})->upper, alone);
}

}  // namespace selvage::verify
