// What held contacts begin with, are told and give on.
#include <gtest/gtest.h>

#include "tests/sim/dynamics/swept_contact_scenes.h"

namespace selvage::sim::testbed {

TEST(HeldContacts, BearWhatTheVertexBoreOnAFaceBeside) {
  // Over the border of two faces a vertex lies on either.
  constexpr double kLoad = 7;
  TwoFaces scene;
  const auto learnt = [&](const std::vector<ContactLoad>& loads) {
    HeldContacts held({scene.one.contact}, {loads, {}}, scene.ground.surface(1), scene.V, scene.V, kHeldStep, 1);
    const std::vector<ContactLoad> begun = held.loads().vf;
    return begun.empty() ? 0 : begun.front().acceleration_m_s2;
  };
  EXPECT_EQ(learnt({{0, 0, kLoad}}), kLoad);
  EXPECT_EQ(learnt({{0, 1, kLoad}}), kLoad);
  EXPECT_EQ(learnt({{0, 0, kLoad}, {0, 1, 3}}), kLoad) << "its own first";
  EXPECT_EQ(learnt({{1, 0, kLoad}}), 0) << "another vertex";
  EXPECT_EQ(learnt({}), 0);
}

TEST(HeldContacts, KnowWhatTheyBoreLastAndWhatTheyEverDid) {
  const TwoFaces scene;
  HeldContacts held({scene.one.contact}, {{{0, 0, 3}}, {}}, scene.ground.surface(1), scene.V, scene.V, kHeldStep, 1);
  EXPECT_EQ(held.count().repulsions, 0) << "what it begins with it has not done";
  held.set_load(0, {5, Vec3(1, 2, 0)}, true, true);
  EXPECT_EQ(held.loads(), (ContactLoads{{{0, 0, 5, {1, 2, 0}}}, {}}));
  held.set_load(0, {}, false, false);
  EXPECT_TRUE(held.loads().empty());
  EXPECT_EQ(held.count().repulsions, 1);
  EXPECT_EQ(held.count().frictions, 1);
  EXPECT_EQ(held.repelled_pairs(), (Candidates{{{0, 0}}, {}}));
}

TEST(HeldContacts, KeepTheLoadOfThePairsContactThatActsFirst) {
  const TwoFaces scene;
  const std::vector<RepulsionContact> twice{scene.one.contact, scene.one.contact};
  HeldContacts held(twice, {}, scene.ground.surface(1), scene.V, scene.V, kHeldStep, 1);
  held.set_load(0, {5, Vec3::Zero()}, true, false);
  held.set_load(1, {3, Vec3::Zero()}, true, false);
  EXPECT_EQ(held.loads(), (ContactLoads{{{0, 0, 5}}, {}}));
  held.act_in({1, 0});
  EXPECT_EQ(held.loads(), (ContactLoads{{{0, 0, 3}}, {}}));
}

TEST(HeldContacts, GiveLoadsOfBothKindsOnInOrder) {
  const TwoFaces scene;
  std::vector<RepulsionContact> contacts(4, scene.one.contact);
  for (const std::size_t i : {2U, 3U}) contacts[i].kind = PairKind::kEe;
  for (const std::size_t i : {0U, 2U}) contacts[i].first = 3;
  HeldContacts held(contacts, {}, scene.ground.surface(1), scene.V, scene.V, kHeldStep, 1);
  for (std::size_t i = 0; i < 4; ++i) held.set_load(i, {double(i + 1), Vec3::Zero()}, true, false);
  EXPECT_EQ(held.loads(), (ContactLoads{{{0, 0, 2}, {3, 0, 1}}, {{0, 0, 4}, {3, 0, 3}}}));
}

TEST(HeldContacts, AreGivenOnAsMeasuredAtTheStart) {
  const TwoFaces scene;
  HeldContacts held({scene.one.contact}, {}, scene.ground.surface(1), scene.V, scene.V, kHeldStep, 1);
  held.contact(0).interaction.weights = {1, -1, 0, 0};  // over the first corner, which is 2 m away in x and y
  held.contact(0).normal = Vec3(0.6, 0, 0.8);
  held.contact(0).mobility = 7;  // of where it was
  const RepulsionContact now = std::move(held).take_contacts().front();
  EXPECT_NEAR(now.distance, 2 * 0.6 + kHeldThickness * 0.8, 1e-15);
  EXPECT_NEAR(now.mobility, 1, 1e-15);
}

}  // namespace selvage::sim::testbed
