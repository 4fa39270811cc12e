#include "sim/contact/straight_surface.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "kernel/mesh.h"
#include "sim/contact/repulsion_contact.h"

namespace selvage::sim {
namespace {

using Kind = StraightSurface::Kind;

StraightFeature feature_of(PairKind kind, const std::array<VertexId, 4>& vertices, const Mesh& mesh, const Positions& V,
                           const std::vector<std::uint8_t>& is_cloth) {
  const VertexFaces faces(mesh);
  StraightSurfaces surfaces(mesh, faces);
  surfaces.start(V);
  return surfaces.of(kind, vertices, is_cloth);
}

/// A roof whose ridge goes along x through five vertices, `bend_m` to the side at the middle one; row i has vertices
/// 3 i (eaves), 3 i + 1 (ridge) and 3 i + 2 (eaves).
struct Roof {
  Mesh mesh;
  Positions V;
  std::vector<std::uint8_t> is_cloth;

  explicit Roof(double height_m, double bend_m = 0) : V(15, 3), is_cloth(15, 0) {
    std::vector<std::array<VertexId, 3>> faces;
    for (VertexId row = 0; row < 5; ++row) {
      for (VertexId side = 0; side < 3; ++side) {
        const double y = side - 1;
        V.row(3 * row + side) << row, y + (row == 2 ? bend_m : 0), height_m * (1 - std::abs(y));
        if (row == 4 || side == 2) continue;
        const VertexId a = 3 * row + side, b = a + 1, c = a + 3, d = a + 4;
        faces.push_back({a, b, c});
        faces.push_back({b, d, c});
      }
    }
    mesh = make_mesh(15, faces);
  }
  [[nodiscard]] StraightSurface at(VertexId vertex) const {
    return feature_of(PairKind::kVf, {vertex, 0, 1, 2}, mesh, V, is_cloth).parts[StraightFeature::kWithin];
  }
  [[nodiscard]] std::array<Kind, 3> along(VertexId a, VertexId b) const {
    const StraightFeature edge = feature_of(PairKind::kEe, {a, b, 0, 1}, mesh, V, is_cloth);
    return {edge.parts[0].kind, edge.parts[1].kind, edge.parts[2].kind};
  }
};

/// Spokes from a vertex in the plane z = 0 at these angles, in turns; one face between each and the next.
StraightSurface around(const std::vector<double>& turns, const std::vector<std::array<VertexId, 3>>& more = {},
                       double height_m = 0) {
  const auto count = static_cast<VertexId>(turns.size());
  Positions V = Positions::Zero(count + 1, 3);
  std::vector<std::array<VertexId, 3>> faces = more;
  for (VertexId k = 0; k < count; ++k) {
    const double angle = 2 * std::numbers::pi * turns[static_cast<std::size_t>(k)];
    V.row(k + 1) << std::cos(angle), std::sin(angle), k == 0 ? height_m : 0;
    if (k > 0) faces.push_back({0, k, k + 1});
  }
  const Mesh mesh = make_mesh(count + 1, faces);
  const std::vector<std::uint8_t> is_cloth(static_cast<std::size_t>(count) + 1, 0);
  return feature_of(PairKind::kVf, {0, 0, 0, 0}, mesh, V, is_cloth).parts[0];
}

}  // namespace

TEST(StraightSurface, IsALineAtAVertexOfARidgeAndAPlaneWhereItIsFlat) {
  const Roof roof(1);
  const StraightSurface ridge = roof.at(7);
  EXPECT_EQ(ridge.kind, Kind::kLine);
  EXPECT_NEAR(std::abs(ridge.direction(roof.V).x()), 1, 1e-15);
  EXPECT_EQ(roof.at(1).kind, Kind::kCorner) << "where the ridge ends";
  const Roof flat(0);
  EXPECT_EQ(flat.at(7).kind, Kind::kPlane);
  EXPECT_NEAR(std::abs(flat.at(7).direction(flat.V).z()), 1, 1e-15);
  EXPECT_EQ(flat.at(6).kind, Kind::kLine) << "its border";
}

TEST(StraightSurface, AnEdgeHasThatOfItsFacesAndThatOfItsEnds) {
  using Kinds = std::array<Kind, 3>;
  const Roof roof(1);
  EXPECT_EQ(roof.along(4, 7), (Kinds{Kind::kCorner, Kind::kLine, Kind::kLine}));
  EXPECT_EQ(roof.along(4, 1), (Kinds{Kind::kCorner, Kind::kLine, Kind::kCorner}));
  EXPECT_EQ(roof.along(6, 7), (Kinds{Kind::kPlane, Kind::kLine, Kind::kLine}));
  EXPECT_EQ(Roof(0).along(4, 7), (Kinds{Kind::kPlane, Kind::kPlane, Kind::kPlane}));
  const Vec3 rafter = feature_of(PairKind::kEe, {6, 7, 0, 1}, roof.mesh, roof.V, roof.is_cloth)
                          .parts[StraightFeature::kWithin]
                          .direction(roof.V);
  EXPECT_NEAR(std::abs(rafter.dot(Vec3(0, -1, 1).normalized())), 1, 1e-15);
}

TEST(StraightSurface, IsFoundAnewWhereVerticesHaveMoved) {
  Roof roof(1);
  const VertexFaces faces(roof.mesh);
  StraightSurfaces surfaces(roof.mesh, faces);
  for (const double bend_m : {0.0, 0.0, 0.1}) {
    roof.V(7, 1) = bend_m;
    surfaces.start(roof.V);
    for (int again = 0; again < 2; ++again) {
      const StraightFeature ridge = surfaces.of(PairKind::kVf, {7, 0, 1, 2}, roof.is_cloth);
      EXPECT_EQ(ridge.parts[0].kind, bend_m == 0 ? Kind::kLine : Kind::kCorner);
    }
  }
}

TEST(StraightSurface, IsOfBodiesAlone) {
  Roof roof(1);
  roof.is_cloth[7] = 1;
  EXPECT_EQ(roof.at(7).kind, Kind::kCorner);
  roof.is_cloth.assign(15, 1);
  EXPECT_EQ(roof.along(4, 7), (std::array<Kind, 3>{}));
  roof.is_cloth[1] = roof.is_cloth[4] = 0;
  const StraightFeature second = feature_of(PairKind::kEe, {6, 7, 1, 4}, roof.mesh, roof.V, roof.is_cloth);
  EXPECT_EQ(second.parts[StraightFeature::kSecondEnd].kind, Kind::kLine);
  EXPECT_TRUE(second.is_anywhere());
  EXPECT_EQ(second.part(PairKind::kEe, {0.5, 0.5, -1, 0}), StraightFeature::kFirstEnd);
  EXPECT_EQ(second.part(PairKind::kEe, {0.5, 0.5, 0, -1}), StraightFeature::kSecondEnd);
  EXPECT_EQ(second.part(PairKind::kEe, {1, 0, -0.5, -0.5}), StraightFeature::kWithin);
  EXPECT_EQ(second.part(PairKind::kVf, {1, -1, 0, 0}), StraightFeature::kWithin);
}

TEST(StraightSurface, RoundingIsStraightAndABendIsNot) {
  EXPECT_EQ(Roof(1, 1e-5).at(7).kind, Kind::kLine);
  EXPECT_EQ(Roof(1, 1e-2).at(7).kind, Kind::kCorner);
}

TEST(StraightSurface, ALineGoesOnWhileItIsStraight) {
  Roof roof(1);
  roof.V.row(13).x() = 6;
  EXPECT_EQ(roof.at(4).extents_m, (std::array<double, 2>{1, 5}));
  roof.V.row(10).y() = 0.1;
  EXPECT_EQ(roof.at(4).extents_m, (std::array<double, 2>{1, 1})) << "to where it bends";
}

TEST(StraightSurface, APlaneGoesAsFarAsTheFacesAroundIt) {
  Roof flat(0);
  flat.V.col(0) *= 2;  // faces of 2 by 1, whose diagonals are from 3 i + side + 1 to 3 (i + 1) + side
  const auto around = [&] { return flat.at(7).extents_m; };
  const auto within = [&](VertexId a, VertexId b, double share) {
    const StraightFeature edge = feature_of(PairKind::kEe, {a, b, 0, 1}, flat.mesh, flat.V, flat.is_cloth);
    const std::array<double, 4> weights{share - 1, -share, 0.5, 0.5};
    const double extent_m = edge.parts.at(edge.part(PairKind::kEe, weights)).extents_m[0];
    return extent_m * edge.extent_share(PairKind::kEe, weights);
  };
  const double over_diagonal = 2 / std::sqrt(5);
  for (const double scale : {1.0, 0x1p+600, 0x1p-600}) {
    SCOPED_TRACE(scale);
    flat.V *= scale;
    EXPECT_NEAR(around()[0] / scale, over_diagonal, 1e-15);
    EXPECT_EQ(around()[0], around()[1]);
    EXPECT_NEAR(within(7, 6, 0.5) / scale, 1, 1e-15) << "2 over the edge, half of it beside its middle";
    EXPECT_NEAR(within(7, 6, 0.25) / scale, 0.5, 1e-15);
    EXPECT_NEAR(within(7, 6, 0.75) / scale, 0.5, 1e-15);
    EXPECT_NEAR(within(7, 6, 0) / scale, over_diagonal, 1e-15) << "that of its end";
    flat.V /= scale;
  }
  flat.V.row(8).x() += 8;  // the face on this side of the edge from 7 to 10 leans over it by four lengths
  flat.V.row(11).x() += 8;
  EXPECT_NEAR(within(7, 10, 0.5), 0.125, 1e-15) << "height 1, of which a quarter is left above the end";
  EXPECT_NEAR(within(10, 7, 0.5), 0.125, 1e-15);
}

TEST(StraightSurface, AVertexWithinAPlaneIsThatHoweverItsFacesAreCut) {
  const std::vector<double> no_two_opposite{0, 0.2, 0.45, 0.6, 0.85}, one_line{0, 0.2, 0.5, 0.6, 0.85};
  const std::array<VertexId, 3> last{0, 5, 1};
  for (const auto& turns : {no_two_opposite, one_line}) {
    EXPECT_EQ(around(turns, {last}).kind, Kind::kPlane);
    EXPECT_EQ(around(turns, {last, {0, 2, 1}, {0, 3, 2}, {0, 4, 3}}).kind, Kind::kPlane) << "some faces twice";
    EXPECT_EQ(around(turns, {last}, 0.01).kind, Kind::kCorner) << "one neighbour is higher";
  }
  EXPECT_EQ(around(no_two_opposite).kind, Kind::kCorner) << "a face is missing";
  EXPECT_EQ(around({0, 0.1, 0.3, 0.5}).kind, Kind::kLine) << "a border";
  EXPECT_EQ(around({0, 0.1, 0.3, 0.5}, {{0, 2, 1}, {0, 3, 2}, {0, 4, 3}}).kind, Kind::kLine) << "the same, twice";
  EXPECT_EQ(around({0, 0.1, 0.3, 0.4}).kind, Kind::kCorner) << "a corner of an open sheet";
}

TEST(StraightSurface, ARibBelowAPlaneLeavesItOne) {
  Positions V(5, 3);
  V << 0, 0, 0, 1, 0, 0, 0.5, 1, 0, 0.5, -1, 0, 0.5, 0, -1;
  for (const bool has_rib : {false, true}) {
    std::vector<std::array<VertexId, 3>> faces{{0, 1, 2}, {1, 0, 3}};
    if (has_rib) faces.push_back({0, 1, 4});
    const Mesh mesh = make_mesh(5, faces);
    const StraightFeature edge = feature_of(PairKind::kEe, {0, 1, 2, 3}, mesh, V, std::vector<std::uint8_t>(5, 0));
    EXPECT_EQ(edge.parts[StraightFeature::kWithin].kind, Kind::kPlane);
    EXPECT_NEAR(std::abs(edge.parts[StraightFeature::kWithin].direction(V).z()), 1, 1e-15);
  }
}

TEST(StraightSurface, WhatIsNotFlatAllRoundIsNoPlane) {
  Roof flat(0);
  flat.V(11, 2) = 0.1;
  EXPECT_EQ(flat.at(7).kind, Kind::kPlane) << "no neighbour";
  flat.V(9, 2) = 0.1;
  EXPECT_EQ(flat.at(7).kind, Kind::kCorner) << "beside two lines across it";
}

TEST(StraightSurface, AFaceWithoutAreaChangesNothing) {
  Positions V(6, 3);
  V << 0, 0, 0, 1, 0, 0, 0, 1, 0, -1, 0, 0, 0, -1, 0, 0, 0, 0;
  const std::vector<std::array<VertexId, 3>> all{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 1}};
  for (const std::size_t count : {4U, 3U}) {
    std::vector<std::array<VertexId, 3>> faces(all.begin(), all.begin() + std::ptrdiff_t(count));
    faces.push_back({0, 5, 1});
    const StraightFeature vertex =
        feature_of(PairKind::kVf, {0, 1, 2, 3}, make_mesh(6, faces), V, std::vector<std::uint8_t>(6, 0));
    EXPECT_EQ(vertex.parts[0].kind == Kind::kPlane, count == 4);
    if (count == 4) {
      EXPECT_NEAR(vertex.parts[0].extents_m[0], std::sqrt(0.5), 1e-15);
    }
  }
}

TEST(StraightSurface, WhatHasNoSizeIsACorner) {
  // Of an edge without length, in whose faces the other corners lie on opposite sides.
  Positions V(4, 3);
  V << 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0;
  const Mesh mesh = make_mesh(4, std::vector<std::array<VertexId, 3>>{{0, 1, 2}, {1, 0, 3}});
  const StraightFeature edge = feature_of(PairKind::kEe, {0, 1, 2, 3}, mesh, V, std::vector<std::uint8_t>(4, 0));
  EXPECT_EQ(edge.parts[StraightFeature::kWithin].kind, Kind::kCorner);
}

TEST(StraightSurface, DirectionsAreAcrossIt) {
  const Vec3 x = Vec3::UnitX(), tilted = Vec3(3, 0, 4).normalized();
  const auto turned = [](Kind kind, const Vec3& direction, const Vec3& unit) -> Vec3 {
    return across({kind, {}, {9, 9}}, 1, direction, unit, 5).unit;
  };
  EXPECT_TRUE(turned(Kind::kLine, x, tilted).isApprox(Vec3(0, 0, 1)));
  EXPECT_TRUE(turned(Kind::kPlane, -x, tilted).isApprox(x)) << "on the side on which it was";
  EXPECT_EQ(turned(Kind::kCorner, Vec3::Zero(), tilted), tilted);
  EXPECT_EQ(turned(Kind::kLine, x, x), x) << "nothing is left";
}

TEST(StraightSurface, APointIsOverItOrBeyond) {
  const Vec3 x = Vec3::UnitX(), tilted = Vec3(3, 0, 4).normalized();
  for (const double extent_m : {2.9, 3.1}) {
    const auto is_beyond = [&](Kind kind, const std::array<double, 2>& extents_m, const Vec3& direction, double share) {
      return across({kind, {}, extents_m}, share, direction, tilted, 5).is_beyond;
    };
    EXPECT_EQ(is_beyond(Kind::kLine, {0, extent_m}, x, 1), extent_m < 3);
    EXPECT_EQ(is_beyond(Kind::kLine, {extent_m, 0}, -x, 1), extent_m < 3);
    EXPECT_EQ(is_beyond(Kind::kPlane, {extent_m, extent_m}, Vec3::UnitZ(), 1), extent_m < 3);
    EXPECT_TRUE(is_beyond(Kind::kPlane, {extent_m, extent_m}, Vec3::UnitZ(), 0.5));
    EXPECT_FALSE(is_beyond(Kind::kCorner, {}, Vec3::Zero(), 1));
  }
  EXPECT_TRUE(across({Kind::kLine, {}, {9, 9}}, 1, x, x, 5).is_beyond) << "in it";
  EXPECT_TRUE(across({Kind::kPlane, {}, {9, 9}}, 1, Vec3::UnitZ(), x, 5).is_beyond) << "in it";
  for (const double tilt : {0.5e-3, 2e-3}) {
    const Vec3 unit = Vec3(tilt, 0, 1).normalized();
    EXPECT_EQ(across({Kind::kPlane}, 1, Vec3::UnitZ(), unit, 5).is_beyond, tilt > 1e-3) << "as straight as it must be";
  }
}

TEST(StraightSurface, AContactIsAsFarAsItIsAcross) {
  RepulsionContact contact;
  const std::array<double, 4> inverse_mass{0, 1, 1, 1};
  contact.interaction = make_interaction(PairKind::kVf, {0, 1, 2, 3}, {1, 1, 0, 0}, inverse_mass);
  Positions V(4, 3);
  V << 0, 0, 0, 3, 0, 4, 1, 0, 0, 0, 1, 0;
  contact.x_t0 = gather(contact.interaction, V);
  contact.normal = Vec3(-0.6, 0, -0.8);
  contact.distance = 5;
  StraightFeature feature;
  feature.parts[StraightFeature::kWithin] = {Kind::kPlane, {0, 2, 0, 3}, {9, 9}};
  turn_across(feature, V, contact);
  EXPECT_FALSE(contact.is_beyond);
  EXPECT_EQ(contact.normal, Vec3(0, 0, -1));
  EXPECT_EQ(contact.distance, 4);
}

}  // namespace selvage::sim
