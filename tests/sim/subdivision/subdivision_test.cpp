#include "sim/subdivision/subdivision.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include <gtest/gtest.h>

#include "sim/base/points.h"
#include "verify/check.h"

namespace selvage {

using namespace sim;

namespace {

std::int64_t violations(const io::Triangles& triangles, const Positions& x) {
  return verify::check_frame(verify::Surface{triangles, {}}, points_of(x), {}).violations_total.total();
}

Mesh mesh_of(const Shape& shape) { return make_mesh(static_cast<std::int32_t>(shape.x.rows()), shape.triangles); }

// Two tents, one over the other: smoothing lowers the coarse upper ridge more than the fine lower one.
Shape two_tents(double gap_m) {
  Shape both = make_sheet(17, 5, 1, 1);
  const Shape upper = make_sheet(5, 4, 1, 1);
  const auto begin = static_cast<std::int32_t>(both.x.rows());
  both.x.conservativeResize(begin + upper.x.rows(), 3);
  both.x.bottomRows(upper.x.rows()) = upper.x;
  for (const auto& t : upper.triangles) both.triangles.push_back({t[0] + begin, t[1] + begin, t[2] + begin});
  for (Eigen::Index i = 0; i < both.x.rows(); ++i) {
    both.x(i, 2) = -std::abs(both.x(i, 0)) + (i >= begin ? gap_m : 0);
  }
  return both;
}

}  // namespace

TEST(Subdivision, RefusesNoLevelsAndGroupsOfNoFaces) {
  const io::Triangles triangle{{0, 1, 2}};
  for (const std::int32_t levels : {0, -1}) {
    EXPECT_THROW(Subdivision(triangle, 3, {}, levels), std::invalid_argument) << levels;
  }
  for (const auto& [begin, end] : {std::pair(-1, 1), {0, 2}, {1, 0}}) {
    EXPECT_THROW(Subdivision(triangle, 3, {{"cloth", io::Group::Role::kCloth, begin, end}}, 1), std::invalid_argument);
  }
}

TEST(Subdivision, RefusesMoreFacesThanAMeshMayHave) {
  EXPECT_TRUE(may_subdivide(1, 14));
  EXPECT_FALSE(may_subdivide(1, 15));
  EXPECT_TRUE(may_subdivide(kMaxFaceCount / 4096, 6));
  EXPECT_FALSE(may_subdivide(kMaxFaceCount / 4096 + 1, 6));
  EXPECT_FALSE(may_subdivide(1, std::numeric_limits<std::int32_t>::max()));
  for (const std::int32_t levels : {15, 16, 1000}) {
    EXPECT_THROW(Subdivision({{0, 1, 2}}, 3, {}, levels), std::invalid_argument) << levels;
  }
}

TEST(LoopRules, AtValenceSixTheyAreLoops) {
  const RingWeights six = ring_weights(6);
  EXPECT_NEAR(six.alpha, 3.0 / 8, 1e-15);
  EXPECT_NEAR(six.beta, 3.0 / 8, 1e-15);
  const double expected[] = {3.0 / 8, 1.0 / 8, 0, 0, 0, 1.0 / 8};
  for (std::size_t j = 0; j < 6; ++j) EXPECT_NEAR(six.ring[j], expected[j], 1e-15);
}

TEST(LoopRules, AreConvexAndHaveTheSpectrumOfBoundedCurvature) {
  for (std::int32_t n = 3; n <= 40; ++n) {
    const RingWeights weights = ring_weights(n);
    double sum = weights.alpha;
    for (const double w : weights.ring) {
      EXPECT_GE(w, 0) << n;
      sum += w;
    }
    EXPECT_NEAR(sum, 1, 1e-14) << n;
    EXPECT_GE(weights.alpha, 0);
    EXPECT_LE(weights.beta, 1);
    // Eigenvalues of the ring by Fourier mode; mode 0 together with the vertex: 1 and 1 - alpha - beta.
    EXPECT_NEAR(1 - weights.alpha - weights.beta, 0.25, 1e-14) << n;
    for (std::int32_t k = 1; k < n; ++k) {
      double eigenvalue = 0;
      for (std::int32_t j = 0; j < n; ++j) {
        eigenvalue += weights.ring[static_cast<std::size_t>(j)] * std::cos(2 * std::numbers::pi * j * k / n);
      }
      const bool subdominant = k == 1 || k == n - 1;
      if (subdominant) {
        EXPECT_NEAR(eigenvalue, 0.5, 1e-13) << n;
      } else {
        EXPECT_LE(std::abs(eigenvalue), 0.25 + 1e-13) << n << " mode " << k;
      }
    }
  }
}

TEST(LoopRules, KeepAPlaneAPlaneAndShrinkASphereWithinItself) {
  const Shape sheet = make_sheet(6, 5, 1, 1);
  const LoopRules flat(mesh_of(sheet), {});
  const Positions fine = flat.smooth(sheet.x);
  EXPECT_EQ(flat.triangles().size(), 4 * sheet.triangles.size());
  EXPECT_LE(fine.col(2).norm(), 0.0);
  EXPECT_LE(fine.col(0).cwiseAbs().maxCoeff(), 0.5);
  EXPECT_EQ(violations(flat.triangles(), fine), 0) << "faces keep their sides";

  const Shape ball = make_sphere(1, 1);
  const LoopRules round(mesh_of(ball), {});
  const Positions smooth = round.smooth(ball.x), split = round.midpoints(ball.x);
  EXPECT_LT(smooth.rowwise().norm().maxCoeff(), 1) << "convex combinations";
  EXPECT_GT(smooth.rowwise().norm().minCoeff(), 0.8);
  // Smoother: the farthest and the nearest point differ less than on the flat faces, in parts of the radius.
  const auto unevenness = [](const Positions& x) {
    return x.rowwise().norm().maxCoeff() / x.rowwise().norm().minCoeff() - 1;
  };
  EXPECT_LT(unevenness(smooth), 0.5 * unevenness(split));
}

/// Where the smooth rule takes the new points, by the edge's ends.
std::map<std::array<VertexId, 2>, Vec3> smooth_edges(const Shape& shape, const std::vector<std::uint8_t>& rigid) {
  const Mesh mesh = mesh_of(shape);
  const Positions fine = LoopRules(mesh, rigid).smooth(shape.x);
  std::map<std::array<VertexId, 2>, Vec3> points;
  for (std::size_t e = 0; e < mesh.edges.size(); ++e) {
    const auto [a, b] = mesh.edges[e];
    points[{std::min(a, b), std::max(a, b)}] = fine.row(shape.x.rows() + static_cast<Eigen::Index>(e));
  }
  return points;
}

TEST(LoopRules, ABoundaryIsTheCubicSplineOfItsOwnVertices) {
  Shape sheet = make_sheet(4, 4, 1, 1);
  for (Eigen::Index v = 0; v < 16; ++v) sheet.x(v, 2) = static_cast<double>(v * 7 % 5);
  const Mesh mesh = mesh_of(sheet);
  const Positions fine = LoopRules(mesh, {}).smooth(sheet.x);
  const auto at = [&](VertexId v) { return Vec3(sheet.x.row(v)); };
  const std::array<std::array<VertexId, 3>, 3> corners = {{{1, 0, 4}, {0, 1, 2}, {1, 2, 3}}};  // before, at, behind
  for (const auto& [before, v, behind] : corners) {
    const Vec3 expected = 0.75 * at(v) + 0.125 * at(before) + 0.125 * at(behind);
    EXPECT_LT((Vec3(fine.row(v)) - expected).norm(), 1e-15) << v;
  }
  for (std::size_t e = 0; e < mesh.edges.size(); ++e) {
    const auto& [a, b] = mesh.edges[e];
    if (std::max(a, b) > 3) continue;  // others than those of the lowest row
    EXPECT_LT((Vec3(fine.row(16 + static_cast<Eigen::Index>(e))) - 0.5 * (at(a) + at(b))).norm(), 1e-15) << a;
  }
}

TEST(LoopRules, DoNotAskWhichWayRoundFacesAre) {
  const Shape ball = make_sphere(1, 2);
  Shape mixed = ball;
  for (std::size_t f = 0; f < mixed.triangles.size(); f += 3) std::swap(mixed.triangles[f][0], mixed.triangles[f][1]);
  const auto vertices = [](const Shape& shape) -> Positions {
    return LoopRules(mesh_of(shape), {}).smooth(shape.x).topRows(shape.x.rows());
  };
  EXPECT_LE((vertices(mixed) - vertices(ball)).cwiseAbs().maxCoeff(), 1e-15);
  const auto expected = smooth_edges(ball, {}), edges = smooth_edges(mixed, {});
  for (const auto& [edge, point] : expected) EXPECT_LE((edges.at(edge) - point).norm(), 1e-15);
}

/// A card with two sides and one face on each.
TEST(LoopRules, VerticesOfTwoFacesBackToBackStay) {
  Shape card;
  card.x.resize(3, 3);
  card.x << 0, 0, 0, 1, 0, 0, 0, 1, 0;
  card.triangles = {{0, 1, 2}, {0, 2, 1}};
  const Positions fine = LoopRules(mesh_of(card), {}).smooth(card.x);
  EXPECT_EQ(fine.topRows(3), card.x);
  EXPECT_TRUE(fine.allFinite());
}

/// A sheet whose faces left of the middle are of a body, with its vertices in either order.
TEST(LoopRules, EdgesFromABodyIntoClothDoNotAskWhichEndComesFirst) {
  Shape sheet = make_sheet(7, 5, 1, 1);
  for (Eigen::Index v = 0; v < sheet.x.rows(); ++v) sheet.x(v, 2) = std::cos(9 * sheet.x(v, 0)) * sheet.x(v, 1);
  std::vector<std::uint8_t> rigid;
  for (const auto& t : sheet.triangles) rigid.push_back((sheet.x(t[0], 0) + sheet.x(t[1], 0) + sheet.x(t[2], 0)) < 0);
  Shape turned = sheet;
  turned.x = sheet.x.colwise().reverse();
  const auto last = static_cast<VertexId>(sheet.x.rows() - 1);
  for (auto& t : turned.triangles) t = {last - t[0], last - t[1], last - t[2]};
  const auto one = smooth_edges(sheet, rigid), other = smooth_edges(turned, rigid);
  for (const auto& [edge, point] : one) {
    EXPECT_LE((other.at({last - edge[1], last - edge[0]}) - point).norm(), 1e-15) << edge[0] << " " << edge[1];
  }
}

TEST(Subdivision, StopsWhatWouldTouchAndStaysExactlyFree) {
  const Shape tents = two_tents(1e-3);
  ASSERT_EQ(violations(tents.triangles, tents.x), 0);
  const LoopRules rules(mesh_of(tents), {});
  EXPECT_GT(violations(rules.triangles(), rules.smooth(tents.x)), 0) << "the scene asks for something";

  const Subdivision subdivision(tents.triangles, static_cast<std::int32_t>(tents.x.rows()), {}, 2);
  SubdivisionCounts counts;
  const Positions fine = subdivision(tents.x, counts);
  EXPECT_EQ(subdivision.triangles().size(), 16 * tents.triangles.size());
  EXPECT_EQ(violations(subdivision.triangles(), fine), 0);
  EXPECT_GT(counts.stopped, 0);
  EXPECT_LT(counts.stopped, fine.rows() / 2) << "most vertices reach their smooth place";
}

TEST(Subdivision, CountsWhatDidNotReachItsSmoothPlace) {
  const Shape tents = two_tents(1e-3);
  const LoopRules rules(mesh_of(tents), {});
  const Subdivision subdivision(tents.triangles, static_cast<std::int32_t>(tents.x.rows()), {}, 1);
  SubdivisionCounts counts;
  const Positions fine = subdivision(tents.x, counts), smooth = rules.smooth(tents.x);
  std::int64_t elsewhere = 0;
  for (Eigen::Index v = 0; v < fine.rows(); ++v) elsewhere += fine.row(v) != smooth.row(v) ? 1 : 0;
  EXPECT_EQ(counts.stopped, elsewhere);
}

TEST(Subdivision, BodiesKeepTheirFaces) {
  const Shape tents = two_tents(0.01);
  const auto lower = static_cast<std::int32_t>(make_sheet(17, 5, 1, 1).triangles.size());
  const auto all = static_cast<std::int32_t>(tents.triangles.size());
  const std::vector<io::Group> groups = {{"stone", io::Group::Role::kBody, 0, lower},
                                         {"cloth", io::Group::Role::kCloth, lower, all}};
  Shape split = tents;
  std::int32_t faces_of_each = 1;
  for (const int levels : {1, 2}) {
    const Subdivision subdivision(tents.triangles, static_cast<std::int32_t>(tents.x.rows()), groups, levels);
    faces_of_each *= 4;
    EXPECT_EQ(subdivision.groups().at(1).face_begin, faces_of_each * lower);
    EXPECT_EQ(subdivision.groups().at(1).face_end, faces_of_each * all);
    SubdivisionCounts counts;
    const Positions fine = subdivision(tents.x, counts);
    split = {LoopRules(mesh_of(split), {}).midpoints(split.x), subdivision.triangles()};
    for (std::int32_t f = 0; f < faces_of_each * lower; ++f) {
      for (const VertexId v : subdivision.triangles()[static_cast<std::size_t>(f)]) {
        EXPECT_EQ(Vec3(fine.row(v)), Vec3(split.x.row(v))) << v << " after " << levels;
      }
    }
    EXPECT_NE(fine, split.x);
  }
}

}  // namespace selvage
