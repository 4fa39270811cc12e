#include "sim/contact/straight_surface.h"

#include <cmath>

#include <gtest/gtest.h>

#include "kernel/mesh.h"

namespace selvage::sim {
namespace {

using Kind = StraightSurface::Kind;

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
    return StraightSurfaces(mesh, VertexFaces(mesh))
        .of(PairKind::kVf, {vertex, 0, 1, 2}, V, is_cloth)
        .parts[StraightFeature::kWithin];
  }
  [[nodiscard]] std::array<Kind, 3> along(VertexId a, VertexId b) const {
    const StraightFeature edge = StraightSurfaces(mesh, VertexFaces(mesh)).of(PairKind::kEe, {a, b, 0, 1}, V, is_cloth);
    return {edge.parts[0].kind, edge.parts[1].kind, edge.parts[2].kind};
  }
};

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
  const Vec3 rafter = StraightSurfaces(roof.mesh, VertexFaces(roof.mesh))
                          .of(PairKind::kEe, {6, 7, 0, 1}, roof.V, roof.is_cloth)
                          .parts[StraightFeature::kWithin]
                          .direction(roof.V);
  EXPECT_NEAR(std::abs(rafter.dot(Vec3(0, -1, 1).normalized())), 1, 1e-15);
}

TEST(StraightSurface, IsOfBodiesAlone) {
  Roof roof(1);
  roof.is_cloth[7] = 1;
  EXPECT_EQ(roof.at(7).kind, Kind::kCorner);
  roof.is_cloth.assign(15, 1);
  EXPECT_EQ(roof.along(4, 7), (std::array<Kind, 3>{}));
  roof.is_cloth[1] = roof.is_cloth[4] = 0;
  const StraightFeature second =
      StraightSurfaces(roof.mesh, VertexFaces(roof.mesh)).of(PairKind::kEe, {6, 7, 1, 4}, roof.V, roof.is_cloth);
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

TEST(StraightSurface, GoesAsFarAsTheFacesAroundIt) {
  Roof flat(0);
  flat.V.col(0) *= 2;  // faces of 2 by 1, whose diagonals are from 3 i + side + 1 to 3 (i + 1) + side
  EXPECT_EQ(Roof(1).at(7).extent_m, 1) << "along the ridge";
  EXPECT_NEAR(flat.at(7).extent_m, 2 / std::sqrt(5), 1e-15) << "the height over a diagonal";
  const auto within = [&](VertexId a, VertexId b, double share) {
    const StraightFeature edge =
        StraightSurfaces(flat.mesh, VertexFaces(flat.mesh)).of(PairKind::kEe, {a, b, 0, 1}, flat.V, flat.is_cloth);
    return edge.extent_m(PairKind::kEe, {share - 1, -share, 0.5, 0.5});
  };
  EXPECT_NEAR(within(7, 6, 0.5), 1, 1e-15) << "2 over the edge in the middle, at most";
  EXPECT_NEAR(within(7, 6, 0.25), 0.5, 1e-15);
  EXPECT_NEAR(within(7, 6, 0.75), 0.5, 1e-15);
  EXPECT_NEAR(within(7, 6, 0), 2 / std::sqrt(5), 1e-15) << "that of its end";
  flat.V.row(8).x() += 8;  // now the face beyond the diagonal stands beside that
  flat.V.row(11).x() += 8;
  const double beside = within(7, 10, 0.5);
  EXPECT_GT(beside, 0);
  EXPECT_LT(beside, 0.5) << "leaving out what is not above the edge";
}

TEST(StraightSurface, APointIsOverItOrBeyond) {
  const Vec3 x = Vec3::UnitX(), tilted = Vec3(3, 0, 4).normalized();
  EXPECT_TRUE(along(Kind::kLine, x, tilted).isApprox(0.6 * x));
  EXPECT_TRUE(along(Kind::kPlane, -x, tilted).isApprox(Vec3(0, 0, 0.8)));
  EXPECT_EQ(along(Kind::kCorner, Vec3::Zero(), tilted), Vec3::Zero());
  for (const double extent_m : {2.9, 3.1}) {
    EXPECT_EQ(is_over(5, along(Kind::kLine, x, tilted), extent_m), extent_m > 3);
    EXPECT_EQ(is_over(5, along(Kind::kPlane, Vec3::UnitZ(), tilted), extent_m), extent_m > 3);
  }
  EXPECT_TRUE(is_over(1, 1e-4 * x, 0)) << "as straight as it must be";
}

TEST(StraightSurface, DirectionsAreAcrossIt) {
  const Vec3 x = Vec3::UnitX(), tilted = Vec3(3, 0, 4).normalized();
  EXPECT_TRUE(across(Kind::kLine, x, tilted).isApprox(Vec3(0, 0, 1)));
  EXPECT_TRUE(across(Kind::kPlane, -x, tilted).isApprox(x)) << "on the side on which it was";
  EXPECT_EQ(across(Kind::kCorner, Vec3::Zero(), tilted), tilted);
  EXPECT_EQ(across(Kind::kLine, x, x), x) << "nothing would be left";
}

}  // namespace selvage::sim
