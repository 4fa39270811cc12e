#include "sim/held_contacts.h"

#include "tests/property.h"
#include "tests/sim/mechanics.h"

namespace selvage::sim::testing {
namespace {

constexpr double kThickness = 0.25, kStep = 0.125;

/// Four vertices of one contact, along z at the start.
struct OneContact {
  RepulsionContact contact;
  Positions V_t0, V_t1;
  Eigen::Index cloth_count;
  LaneVectors x, v;

  OneContact(const RandomPair& pair, Eigen::Index cloth_vertices) : V_t0(4, 3), cloth_count(cloth_vertices) {
    for (Eigen::Index i = 0; i < 4; ++i) V_t0.row(i) = pair.x_t0[static_cast<std::size_t>(i)];
    V_t1 = V_t0;
    contact.kind = pair.interaction.weights[1] > 0 ? PairKind::kEe : PairKind::kVf;
    contact.interaction = pair.interaction;
    contact.x_t0 = pair.x_t0;
    contact.normal = relative(pair.interaction, pair.x_t0).normalized();
    contact.distance = relative(pair.interaction, pair.x_t0).norm();
    contact.mobility = effective_mobility(pair.interaction);
    contact.properties.thickness_m = kThickness;
    x.copy(V_t0.topRows(cloth_count));
    v.resize(cloth_count);
    for (Eigen::Index i = 0; i < cloth_count; ++i) v.row(i) = pair.displacement[static_cast<std::size_t>(i)];
  }

  /// One step of a collision step of one.
  RepulsionCount step() {
    for (Eigen::Index i = 0; i < cloth_count; ++i) x.row(i) += kStep * v.row(i);
    const std::vector<RepulsionContact> contacts{contact};
    HeldContacts held(contacts, V_t0, V_t1, cloth_count, kStep);
    held.hold({kStep, 1, x, v});
    return held.count();
  }

  [[nodiscard]] PairVectors velocities() const {
    PairVectors result = zero_vectors();
    for (Eigen::Index i = 0; i < cloth_count; ++i) result[static_cast<std::size_t>(i)] = v.row(i);
    return result;
  }
  /// Along the direction, at the end.
  [[nodiscard]] double distance() const {
    PairVectors at;
    for (Eigen::Index i = 0; i < 4; ++i) {
      at[static_cast<std::size_t>(i)] = i < cloth_count ? Vec3(x.row(i)) : Vec3(V_t1.row(i));
    }
    return relative(contact.interaction, at).dot(contact.normal);
  }
};

/// A vertex a thickness above the middle of a face of a body, which moves by `moved` within the step.
OneContact vertex_over_body(const Vec3& velocity, const Vec3& moved = Vec3::Zero()) {
  RandomPair pair;
  pair.x_t0 = {Vec3(0, 0, kThickness), Vec3(-2, -2, 0), Vec3(2, -2, 0), Vec3(0, 4, 0)};
  pair.displacement = {velocity, Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
  pair.interaction =
      make_interaction(PairKind::kVf, {0, 1, 2, 3}, {1, 1.0 / 3, 1.0 / 3, 1.0 / 3}, std::array<double, 4>{1, 0, 0, 0});
  OneContact one(pair, 1);
  one.contact.properties.friction_static = 0.5;
  one.contact.properties.friction_kinetic = 0.4;
  for (Eigen::Index i = 1; i < 4; ++i) one.V_t1.row(i) += moved.transpose();
  return one;
}

}  // namespace

TEST(HeldContacts, ComeNoNearerThanTheThicknessAndAddNeitherMomentumNorEnergy) {
  selvage::testing::check_property(300, 31, [] {
    const RandomPair pair = random_contact(number_between(1e-3, 0.4));
    RC_PRE(lever_share(pair.interaction) == 1);
    OneContact one(pair, 4);
    one.contact.properties.friction_static = one.contact.properties.friction_kinetic = number_between(0, 1);
    const Mechanics m0 = mechanics(pair.x_t0, pair.displacement, pair.inverse_mass);
    const RepulsionCount count = one.step();
    const Mechanics m1 = mechanics(pair.x_t0, one.velocities(), pair.inverse_mass);
    RC_ASSERT((m1.linear - m0.linear).norm() <= 1e-12 * m0.linear_scale);
    RC_ASSERT(m1.energy <= m0.energy * (1 + 1e-12));
    for (Eigen::Index i = 0; i < 4; ++i) {
      RC_ASSERT((one.x.row(i) - one.V_t0.row(i) - kStep * one.v.row(i)).norm() <= 1e-12);  // x follows v
    }
    RC_CLASSIFY(count.repulsions > 0);
    if (count.repulsions > 0) RC_ASSERT(one.distance() >= std::min(kThickness, one.contact.distance) - 1e-12);
  });
}

TEST(HeldContacts, StickWithinTheConeAndSlideBeyond) {
  OneContact sticks = vertex_over_body({0.4, 0, -1});
  EXPECT_EQ(sticks.step().frictions, 1);
  EXPECT_LT(sticks.v.row(0).norm(), 1e-15);
  EXPECT_LT((sticks.x.row(0) - sticks.V_t0.row(0)).norm(), 1e-15);

  OneContact slides = vertex_over_body({0.9, 0, -1});
  EXPECT_EQ(slides.step().frictions, 1);
  EXPECT_LT((slides.v.row(0) - Eigen::RowVector3d(0.9 - 0.4, 0, 0)).norm(), 1e-15);

  OneContact leaves = vertex_over_body({0.9, 0, 1});
  EXPECT_EQ(leaves.step().repulsions, 0);
  EXPECT_EQ(Eigen::RowVector3d(leaves.v.row(0)), Eigen::RowVector3d(0.9, 0, 1));
}

TEST(HeldContacts, FollowTheBodyTheyLieOn) {
  OneContact one = vertex_over_body({0, 0, 0}, kStep * Vec3(0.2, 0, 1));
  one.step();
  EXPECT_LT((one.v.row(0) - Eigen::RowVector3d(0.2, 0, 1)).norm(), 1e-14);
  EXPECT_NEAR(one.distance(), kThickness, 1e-15);
}

TEST(HeldContacts, AreGivenOnAsTheyWereLastLookedAt) {
  // It slides over the border of the face at y = -2, and is pressed there: along the line to the border.
  OneContact one = vertex_over_body({0, -2.1 / kStep, 0});
  const std::vector<RepulsionContact> contacts{one.contact};
  HeldContacts held(contacts, one.V_t0, one.V_t1, 1, 2 * kStep);
  EXPECT_EQ(held.contacts().front().normal, one.contact.normal);
  one.x.row(0) += kStep * one.v.row(0);
  held.hold({kStep, 0.5, one.x, one.v});
  one.v.row(0) = Eigen::RowVector3d(0, 0, -1);
  one.x.row(0) += kStep * one.v.row(0);
  held.hold({kStep, 1, one.x, one.v});
  const RepulsionContact now = held.contacts().front();
  EXPECT_LT((now.normal - Vec3(0, -0.1, kThickness).normalized()).norm(), 1e-12);
  EXPECT_NEAR(now.distance, (Vec3(0, 0, kThickness) - Vec3(0, -2, 0)).dot(now.normal), 1e-12);
  const Vec3 moved = one.x.row(0) - one.V_t0.row(0);
  EXPECT_GE(now.distance + moved.dot(now.normal), kThickness - 1e-12);
}

TEST(HeldContacts, EndWhereThePointsHaveSlidOffEachOther) {
  // Two steps: to the side, then down. The face ends at y = -2.
  for (const double to_y : {-1.9, -2.5}) {
    OneContact one = vertex_over_body({0, to_y / kStep, 0});
    const std::vector<RepulsionContact> contacts{one.contact};
    HeldContacts held(contacts, one.V_t0, one.V_t1, 1, 2 * kStep);
    one.x.row(0) += kStep * one.v.row(0);
    held.hold({kStep, 0.5, one.x, one.v});
    one.v.row(0) = Eigen::RowVector3d(0, 0, -0.5);
    one.x.row(0) += kStep * one.v.row(0);
    held.hold({kStep, 1, one.x, one.v});
    EXPECT_EQ(held.count().repulsions, to_y > -2 ? 1 : 0);
    EXPECT_EQ(one.distance() < kThickness, to_y < -2);
  }
}

}  // namespace selvage::sim::testing
