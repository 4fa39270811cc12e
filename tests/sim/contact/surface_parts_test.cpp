#include "sim/contact/surface_parts.h"

#include <gtest/gtest.h>

namespace selvage::sim::testbed {

TEST(SurfaceParts, PinnedClothIsClothAndABodyIsNot) {
  // Faces 0-1-2 and 1-2-3 are cloth with 1, 2, 3 pinned by body 0; 4-5-6 is body 0; 7-8-9 has no mass and no body.
  Faces F(4, 3);
  F << 0, 1, 2, 1, 2, 3, 4, 5, 6, 7, 8, 9;
  const Mesh mesh = make_mesh(10, F);
  const std::vector<double> inverse_mass{1, 0, 0, 0, 0, 0, 0, 0, 0, 0};
  const std::vector<std::int32_t> body{-1, 0, 0, 0, 0, 0, 0, -1, -1, -1};
  const auto flags = SurfaceParts(mesh).cloth_flags({inverse_mass, body, SqueezePolicy::kStop});
  EXPECT_EQ(flags, (std::vector<std::uint8_t>{1, 1, 1, 1, 0, 0, 0, 1, 1, 1}));
}

TEST(SurfaceParts, ThatPinsHoldAllOverAreCloth) {
  Faces F(2, 3);
  F << 0, 1, 2, 3, 4, 5;  // body 0, and cloth that pin 1 holds
  const Mesh mesh = make_mesh(6, F);
  const std::vector<double> inverse_mass(6, 0);
  const std::vector<std::int32_t> body{0, 0, 0, 1, 1, 1};
  const CollisionBodies bodies{inverse_mass, body, SqueezePolicy::kStop, 1};
  EXPECT_EQ(SurfaceParts(mesh).cloth_flags(bodies), (std::vector<std::uint8_t>{0, 0, 0, 1, 1, 1}));
}

TEST(SurfaceParts, SpreadAFlagOverTheWholePart) {
  Faces F(2, 3);
  F << 0, 1, 2, 4, 5, 6;
  const Mesh mesh = make_mesh(7, F);
  EXPECT_EQ(SurfaceParts(mesh).spread({0, 0, 0, 0, 0, 1, 0}), (std::vector<std::uint8_t>{0, 0, 0, 0, 1, 1, 1}));
  EXPECT_EQ(SurfaceParts(mesh).spread({0, 0, 1, 1, 0, 0, 0}), (std::vector<std::uint8_t>{1, 1, 1, 1, 0, 0, 0}));
}

TEST(SurfaceParts, AreConnectedWhateverTheOrderOfEdges) {
  // A strip numbered from both ends to the middle: joins happen out of order.
  constexpr VertexId kCount = 101;
  Faces F(kCount - 2, 3);
  const auto number = [](VertexId i) { return i % 2 == 0 ? i / 2 : kCount - 1 - i / 2; };
  for (VertexId i = 0; i + 2 < kCount; ++i) F.row(i) << number(i), number(i + 1), number(i + 2);
  const Mesh mesh = make_mesh(kCount, F);
  std::vector<double> inverse_mass(kCount, 0);
  inverse_mass[50] = 1;
  const std::vector<std::int32_t> body(kCount, 0);
  const auto flags = SurfaceParts(mesh).cloth_flags({inverse_mass, body, SqueezePolicy::kStop});
  EXPECT_EQ(flags, std::vector<std::uint8_t>(kCount, 1));
}

}  // namespace selvage::sim::testbed
