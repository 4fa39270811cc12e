// Energy that contact adds, by what hangs together.
#include "sim/dynamics/contact_gains.h"

#include <gtest/gtest.h>

namespace selvage::sim {
namespace {

constexpr VertexId kClothCount = 6;

/// A light triangle, one a million times as heavy, and a body.
struct TwoCloths {
  Mesh mesh = make_mesh(9, (Faces(3, 3) << 0, 1, 2, 3, 4, 5, 6, 7, 8).finished());
  SurfaceParts parts{mesh};
  std::vector<double> inverse_mass{1, 1, 1, 1e-6, 1e-6, 1e-6, 0, 0, 0};
  LaneVectors before, after;

  /// The light one speeds up from 1 to 3 m/s, and the heavy one slows down from there.
  TwoCloths() {
    for (LaneVectors* v : {&before, &after}) v->resize(kClothCount);
    for (VertexId i = 0; i < kClothCount; ++i) {
      before.row(i).x() = i < 3 ? 1 : 3;
      after.row(i).x() = 4 - before.row(i).x();
    }
  }
  [[nodiscard]] ContactGains gains(const std::vector<RepulsionContact>& contacts) const {
    ContactGains result(parts, contacts, inverse_mass, kClothCount);
    result.add_motion(before, after);
    return result;
  }
  [[nodiscard]] RepulsionContact contact(const std::array<VertexId, 4>& vertices) const {
    RepulsionContact result;
    result.interaction = make_interaction(PairKind::kVf, vertices, {1, 0.25, 0.25, 0.5}, inverse_mass);
    return result;
  }
};

}  // namespace

TEST(ContactGains, WhatElseLosesHidesNothing) {
  const TwoCloths cloths;
  const std::vector<RepulsionContact> on_a_body{cloths.contact({0, 6, 7, 8}), cloths.contact({6, 3, 4, 5})};
  ContactGains gains = cloths.gains(on_a_body);
  EXPECT_TRUE(gains.exceed(3.99));
  EXPECT_FALSE(gains.exceed(4.01)) << "(3^2 - 1^2) / 2 J/kg";
  gains.clear();
  EXPECT_FALSE(gains.exceed(0));
}

TEST(ContactGains, WhatMeetsGainsTogether) {
  const TwoCloths cloths;
  EXPECT_FALSE(cloths.gains({cloths.contact({0, 3, 4, 5})}).exceed(0));
}

TEST(ContactGains, WorkFromOutsideIsNone) {
  const TwoCloths cloths;
  ContactGains gains = cloths.gains({});
  gains.take_work(5, 1e9);
  gains.take_work(1, 11.9);
  EXPECT_TRUE(gains.exceed(0.03));
  gains.take_work(2, 0.2);
  EXPECT_FALSE(gains.exceed(0));
}

TEST(ContactGains, RoundingIsNone) {
  TwoCloths cloths;
  cloths.after = cloths.before;
  cloths.after.row(0).x() = 1 + 0x1p-40;
  EXPECT_FALSE(cloths.gains({}).exceed(0));
  cloths.after.row(0).x() = 1 + 0x1p-30;
  EXPECT_TRUE(cloths.gains({}).exceed(0));
}

}  // namespace selvage::sim
