#include "sim/response/impulse.h"

#include <random>

#include "tests/property.h"
#include "tests/sim/mechanics.h"
#include "tests/sim/response/response_properties.h"

namespace selvage::sim::testbed {
namespace {

using selvage::testing::check_property;

/// Two nodes alone: vertex-face with all weight on one corner; the other corners are as heavy and stand still.
Interaction node_against_node(double inverse_mass_p, double inverse_mass_a) {
  const std::array<double, 4> inverse_mass{inverse_mass_p, inverse_mass_a, 1, 1};
  return make_interaction(PairKind::kVf, {0, 1, 2, 3}, {1, 1, 0, 0}, inverse_mass);
}

}  // namespace

TEST(Distribute, IsThePapersFormulaForEqualMasses) {
  // Paper, 7.1: I~ = 2 I / (1 + w1^2 + w2^2 + w3^2), v_i += w_i I~ / m n, v_4 -= I~ / m n with I = m v_N / 2.
  const std::array<double, 3> w{0.5, 0.3, 0.2};
  const double m = 0.7, approach = -2;
  const std::array<double, 4> inverse_mass{1 / m, 1 / m, 1 / m, 1 / m};
  const Interaction pair = make_interaction(PairKind::kVf, {0, 1, 2, 3}, {1, w[0], w[1], w[2]}, inverse_mass);
  const Vec3 normal(0, 0, 1);
  const double impulse = 2 * (m * approach / 2) / (1 + w[0] * w[0] + w[1] * w[1] + w[2] * w[2]);
  const PairVectors change = distribute(pair, -approach * normal);
  EXPECT_NEAR(change[0].z(), -impulse / m, 1e-15);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(change[i + 1].z(), w[i] * impulse / m, 1e-15);
}

TEST(Distribute, InelasticCollisionOfTwoMassesEndsAtTheCommonVelocity) {
  struct {
    double mass_p, mass_a;
  } const cases[] = {{1, 1}, {1, 3}, {5, 0.25}, {1e-3, 1e3}};
  for (const auto& c : cases) {
    const Interaction pair = node_against_node(1 / c.mass_p, 1 / c.mass_a);
    PairVectors v{Vec3(0, 0, -2), Vec3(0, 0, 1), Vec3(0, 0, 0), Vec3(0, 0, 0)};
    v = sum(v, distribute(pair, -relative(pair, v)));
    const double common = (c.mass_p * -2 + c.mass_a * 1) / (c.mass_p + c.mass_a);
    EXPECT_NEAR(v[0].z(), common, 1e-14);
    EXPECT_NEAR(v[1].z(), common, 1e-14);
    EXPECT_EQ(v[2], Vec3(0, 0, 0));
  }
}

TEST(Distribute, InfiniteMassDoesNotMove) {
  const Interaction pair = node_against_node(1 / 3.0, 0);
  const PairVectors change = distribute(pair, Vec3(0, 0, 2));
  EXPECT_EQ(change[0], Vec3(0, 0, 2));
  EXPECT_EQ(change[1], Vec3(0, 0, 0));
  const PairVectors none = distribute(node_against_node(0, 0), Vec3(0, 0, 2));
  for (const Vec3& c : none) EXPECT_EQ(c, Vec3(0, 0, 0));
}

// Else products of masses would leave the range of doubles.
TEST(Distribute, WhatIsTooHeavyBesideTheOthersDoesNotMove) {
  EXPECT_TRUE(is_closed(node_against_node(1, 0x1p-99)));
  const Interaction pair = node_against_node(1, 0x1p-101);
  EXPECT_FALSE(is_closed(pair));
  EXPECT_EQ(distribute(pair, Vec3(0, 0, 2))[1], Vec3(0, 0, 0));
}

TEST(Distribute, DoesNotThrowTheFreeCornerOfAPinnedTriangle) {
  const std::array<double, 4> inverse_mass{0, 1, 0, 0};
  for (const double lever : {2.0, kMaxLever, 16.0, 64.0, 1e9}) {
    const double weight = 1 / lever;
    const Interaction pair =
        make_interaction(PairKind::kVf, {0, 1, 2, 3}, {1, weight, 0.5, 0.5 - weight}, inverse_mass);
    const PairVectors change = distribute(pair, Vec3(0, 0, 1));
    const double moved = lever > kMaxLever ? kMaxLever * kMaxLever / lever : lever;
    EXPECT_NEAR(change[1].z(), -moved, 1e-12 * moved) << lever;
  }
}

TEST(Distribute, ChangesTheRelativeMotionAsAskedAndKeepsMomentum) {
  check_property(300, 11, prop_impulse_does_what_is_asked);
}

TEST(Distribute, KeepsAngularMomentumAlongTheLineOfThePoints) {
  check_property(300, 12, [] {
    const RandomPair pair = random_pair(false);
    const Vec3 line = relative(pair.interaction, pair.x_t0);
    const PairVectors after = sum(pair.displacement, distribute(pair.interaction, number_between(-2, 2) * line));
    const Mechanics m0 = mechanics(pair.x_t0, pair.displacement, pair.inverse_mass);
    const Mechanics m1 = mechanics(pair.x_t0, after, pair.inverse_mass);
    RC_ASSERT((m1.angular - m0.angular).norm() <= 1e-12 * (m0.angular_scale + m1.angular_scale));
  });
}

TEST(CollisionChange, StopsTheApproachAndPushesToTwoTolerances) {
  EXPECT_EQ(collision_change(1, -3, 1e-6), 3);                             // stopped at its distance
  EXPECT_EQ(collision_change(1, 3, 1e-6), 0);                              // leaves by itself
  EXPECT_DOUBLE_EQ(collision_change(0.5e-6, -1e-3, 1e-6), 1e-3 + 1.5e-6);  // stopped, then pushed
  EXPECT_DOUBLE_EQ(collision_change(0.5e-6, 0.25e-6, 1e-6), 1.25e-6);      // separating, but too slowly
  EXPECT_EQ(collision_change(0.5, -0.25, 0), 0.25);
}

TEST(CollisionImpulse, OfAClosedPairKeepsBothMomentaAndAddsNoEnergy) {
  check_property(300, 13, [] {
    const RandomPair pair = random_pair(false);
    Positions V_t0(4, 3), V_t1(4, 3);
    for (Eigen::Index i = 0; i < 4; ++i) {
      V_t0.row(i) = pair.x_t0[static_cast<std::size_t>(i)];
      V_t1.row(i) = pair.x_t0[static_cast<std::size_t>(i)] + pair.displacement[static_cast<std::size_t>(i)];
    }
    StepMotion motion;
    motion.start(V_t0, V_t1, Precision::kFloat64);
    const PairVectors before = gather(pair.interaction, motion.displacement());
    Collision collision{};
    collision.ccd.normal = vector_within(1).normalized();
    const PairChange change = collision_impulse(collision, pair.interaction, motion, 0);
    const PairVectors after = sum(before, change.change);
    const Vec3 line = relative(pair.interaction, pair.x_t0);
    RC_PRE(line.norm() > 1e-3);
    const double approach = relative(pair.interaction, before).dot(line);
    const double approach_after = relative(pair.interaction, after).dot(line);
    if (approach < 0 && lever_share(pair.interaction) == 1) RC_ASSERT(std::abs(approach_after) <= 1e-12);
    if (approach >= 0) RC_ASSERT(approach_after == approach);
    const Mechanics m0 = mechanics(pair.x_t0, before, pair.inverse_mass);
    const Mechanics m1 = mechanics(pair.x_t0, after, pair.inverse_mass);
    RC_ASSERT((m1.linear - m0.linear).norm() <= 1e-12 * (m0.linear_scale + m1.linear_scale));
    RC_ASSERT((m1.angular - m0.angular).norm() <= 1e-12 * (m0.angular_scale + m1.angular_scale));
    RC_ASSERT(m1.energy <= m0.energy * (1 + 1e-12));
  });
}

// A vertex of cloth on a body, by a normal that would have it on the other side.
TEST(CollisionImpulse, PushesToTheSideOnWhichThePointsWereAtFirst) {
  const std::array<double, 4> inverse_mass{1, 0, 0, 0};
  const Interaction pair = make_interaction(PairKind::kVf, {0, 1, 2, 3}, {1, 0.5, 0.25, 0.25}, inverse_mass);
  Positions V_t0(4, 3), V_t1(4, 3);
  V_t0 << 0, 0, 1, -1, 0, 0, 1, 1, 0, 1, -1, 0;
  V_t1 = V_t0;
  V_t1(0, 2) = -1;
  StepMotion motion;
  motion.start(V_t0, V_t1, Precision::kFloat64);
  Collision collision{};
  for (const Vec3& normal : {Vec3(0, 0, 1), Vec3(0, 0, -1)}) {
    collision.ccd.normal = normal;
    EXPECT_NEAR(collision_impulse(collision, pair, motion, 0).change[0].z(), 2, 1e-15);
  }
}

TEST(CollisionImpulse, ContactsOfCollisionsAreSeenFromTheSideOnWhichThePointsWereAtFirst) {
  const std::array<double, 4> inverse_mass{1, 0, 0, 0};
  Positions V_t0(4, 3);
  V_t0 << 0, 0, 1, -1, 0, 0, 1, 1, 0, 1, -1, 0;
  Collision collision{};
  collision.kind = PairKind::kVf;
  collision.ccd.weights = {1, 0.5, 0.25, 0.25};
  for (const Vec3& normal : {Vec3(0, 0, 1), Vec3(0, 0, -1)}) {
    collision.ccd.normal = normal;
    const auto contact = make_contact(collision, {0, 1, 2, 3}, {}, V_t0, inverse_mass);
    ASSERT_TRUE(contact);
    EXPECT_EQ(contact->normal, Vec3(0, 0, 1));
    EXPECT_EQ(contact->distance, 1);
  }
}

TEST(ParallelUpdate, ManyInelasticImpulsesAtOnceKeepMomentumAndAddNoEnergy) {
  // Ten vertices, thirty random pairs on them: every vertex takes part in about twelve.
  check_property(100, 14, [] {
    constexpr Eigen::Index kVertexCount = 10;
    std::mt19937_64 engine(*rc::gen::arbitrary<std::uint64_t>());
    std::uniform_real_distribution<double> unit(-1, 1);
    const auto random_positions = [&] { return Positions::NullaryExpr(kVertexCount, 3, [&] { return unit(engine); }); };
    const Positions V_t0 = random_positions();
    StepMotion motion;
    motion.start(V_t0, V_t0 + random_positions(), Precision::kFloat64);
    std::vector<double> inverse_mass;
    for (Eigen::Index i = 0; i < kVertexCount; ++i) inverse_mass.push_back(std::exp2(4 * unit(engine)));
    std::vector<PairChange> changes;
    for (int k = 0; k < 30; ++k) {
      std::array<VertexId, 4> vertices{0, 1, 2, 3};
      std::array<VertexId, kVertexCount> all{0, 1, 2, 3, 4, 5, 6, 7, 8, 9};
      std::shuffle(all.begin(), all.end(), engine);
      std::copy_n(all.begin(), 4, vertices.begin());
      const double a = (1 + unit(engine)) / 2, b = (1 + unit(engine)) / 2;
      const Interaction pair = make_interaction(PairKind::kEe, vertices, {1 - a, a, 1 - b, b}, inverse_mass);
      changes.push_back(collision_impulse({}, pair, motion, 0));
    }
    const auto rows = [](const Positions& X) {
      std::vector<Vec3> list;
      for (Eigen::Index i = 0; i < X.rows(); ++i) list.emplace_back(X.row(i));
      return list;
    };
    const std::vector<Vec3> x = rows(V_t0), before = rows(motion.displacement());
    ParallelUpdate(kVertexCount).apply(changes, 1, motion);
    const std::vector<Vec3> after = rows(motion.displacement());
    const Mechanics m0 = mechanics(x, before, inverse_mass), m1 = mechanics(x, after, inverse_mass);
    RC_ASSERT((m1.linear - m0.linear).norm() <= 1e-12 * m0.linear_scale);
    RC_ASSERT((m1.angular - m0.angular).norm() <= 1e-12 * m0.angular_scale);
    RC_ASSERT(m1.energy < m0.energy);
  });
}

TEST(ParallelUpdate, NodeBetweenTwoApproachingTrianglesIsStoppedInOneRound) {
  // The paper's example (7.4) for parallel updates: the two impulses cancel in the node, each triangle is stopped half,
  // or by the cap where that is less.
  Positions V_t0 = Positions::Zero(7, 3), V_t1 = Positions::Zero(7, 3);
  for (Eigen::Index i = 1; i < 7; ++i) {
    V_t0(i, 2) = i < 4 ? 1 : -1;
    V_t1(i, 2) = 0;
  }
  const std::vector<double> inverse_mass(7, 1.0);
  for (const double cap : {1.0, 0.25}) {
    StepMotion motion;
    motion.start(V_t0, V_t1, Precision::kFloat64);
    std::vector<PairChange> changes;
    for (const VertexId first : {1, 4}) {
      const Interaction pair = make_interaction(PairKind::kVf, {0, first, first + 1, first + 2},
                                                {1, 1 / 3.0, 1 / 3.0, 1 / 3.0}, inverse_mass);
      changes.push_back(collision_impulse({}, pair, motion, 0));
    }
    ParallelUpdate(7).apply(changes, cap, motion);
    const double share = std::min(cap, 0.5);
    EXPECT_EQ(motion.displacement().row(0).norm(), 0);
    EXPECT_NEAR(motion.displacement()(1, 2), -1 + 0.25 * share, 1e-15);
    EXPECT_NEAR(motion.displacement()(4, 2), 1 - 0.25 * share, 1e-15);
  }
}

}  // namespace selvage::sim::testbed
