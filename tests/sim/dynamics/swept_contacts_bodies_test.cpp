// How contacts that are swept over rub on a body, and go with it.
#include <array>
#include <utility>

#include <gtest/gtest.h>

#include "sim/dynamics/central_differences.h"
#include "tests/sim/dynamics/swept_contact_scenes.h"

namespace selvage::sim::testbed {

TEST(SweptContacts, StickWithinTheConeAndSlideBeyond) {
  OneContact sticks = vertex_over_body({0.4, 0, -1});
  EXPECT_EQ(sticks.step().frictions, 1);
  EXPECT_LT(sticks.v.row(0).norm(), 1e-15);
  EXPECT_LT((sticks.x.row(0) - sticks.V_t0.row(0)).norm(), 1e-15);

  OneContact slides = vertex_over_body({1.9, 0, -1});
  EXPECT_EQ(slides.step().frictions, 1);
  EXPECT_LT((slides.v.row(0) - Eigen::RowVector3d(1.9 - 0.4, 0, 0)).norm(), 1e-15);

  OneContact creeps = vertex_over_body({0.9, 0, -1});
  EXPECT_EQ(creeps.step().frictions, 1);
  EXPECT_LT((creeps.v.row(0) - Eigen::RowVector3d(0.9 - 0.5, 0, 0)).norm(), 1e-15)
      << "slower than four steps of gravity";

  OneContact leaves = vertex_over_body({0.9, 0, 1});
  EXPECT_EQ(leaves.step().repulsions, 0);
  EXPECT_EQ(Eigen::RowVector3d(leaves.v.row(0)), Eigen::RowVector3d(0.9, 0, 1));
}

TEST(SweptContacts, WhatCreepsIsAskedOfStepsOfTheDynamicsHoweverManyThereAre) {
  for (const int steps : {1, 2, 8}) {
    for (const auto& [slips_m_s, rubbed_m_s] : {std::pair{0.89, 0.5}, {0.91, 0.4}}) {
      OneContact one = vertex_over_body({slips_m_s, 0, -1});  // it falls for four steps to 0.5 m/s
      const Ground ground = one_face();
      Swept held({one.contact}, {}, ground.surface(1), one.V_t0, one.V_t1, steps * kHeldStep, 1);
      move_and_hold(one, held, one.v.row(0), 1.0 / steps);
      EXPECT_NEAR(one.v.row(0).x(), slips_m_s - rubbed_m_s, 1e-14) << steps;
    }
  }
}

// Of a body's vertex, which remembers no friction to begin with.
TEST(SweptContacts, RubInEveryStepAsMuchAsInTheFirst) {
  Positions V(4, 3);
  V << -2, -2, 0, 2, -2, 0, 0, 4, 0, 0, 0, kHeldThickness;
  RepulsionContact contact;
  contact.first = 3;
  contact.interaction =
      make_interaction(PairKind::kVf, {3, 0, 1, 2}, {1, 1.0 / 3, 1.0 / 3, 1.0 / 3}, std::array<double, 4>{1, 1, 1, 0});
  contact.x_t0 = gather(contact.interaction, V);
  contact.normal = Vec3::UnitZ();
  contact.distance = kHeldThickness;
  contact.mobility = effective_mobility(contact.interaction);
  contact.properties = {kHeldThickness, 1e-6, 0.5, 0.4};
  const Ground ground(Faces{{0, 1, 2}}, {1, 1, 1, 0});
  LaneVectors x, v;
  x.copy(V.topRows(3));
  v.resize(3);
  Swept held({contact}, {}, ground.surface(3), V, V, 2 * kHeldStep, 1);
  for (const double share : {0.5, 1.0}) {
    x.copy(V.topRows(3));  // where the vertex is above the middle of the face
    for (Eigen::Index i = 0; i < 3; ++i) {
      v.row(i) = Eigen::RowVector3d(1.9, 0, 1);
      x.row(i) += kHeldStep * v.row(i);
    }
    act(held, {kHeldStep, share, x, v});
    for (Eigen::Index i = 0; i < 3; ++i) {
      EXPECT_LT((v.row(i) - Eigen::RowVector3d(1.9 - 0.4, 0, 0)).norm(), 1e-14) << share;
    }
  }
}

TEST(SweptContacts, FollowABodyOnABentWayInEveryStep) {
  constexpr int kSteps = 5;
  OneContact one = vertex_over_body({0, 0, 0}, Vec3(0, 0, 0.3));
  const Ground ground = one_face();
  Positions bow_m = Positions::Zero(3, 3);
  bow_m.col(2).setConstant(0.25);
  HeldSurface surface = ground.surface(1);
  surface.bow_m = &bow_m;
  Swept held({one.contact}, {}, surface, one.V_t0, one.V_t1, kSteps * kHeldStep, 1);
  double before_m = 0;
  for (int step = 1; step <= kSteps; ++step) {
    const double share = double(step) / kSteps, rises_m = share * 0.3 - share * (1 - share) * 0.25;
    move_and_hold(one, held, {0, 0, -1}, share);
    EXPECT_NEAR(one.v.row(0).z(), (rises_m - before_m) / kHeldStep, 1e-13) << step;
    EXPECT_NEAR(one.x.row(0).z(), kHeldThickness + rises_m, 1e-14) << step;
    before_m = rises_m;
  }
}

TEST(SweptContacts, HoldClothOnABodyInEveryStepOfCentralDifferences) {
  constexpr int kSteps = 8;
  for (const double rises_m : {0.0, 0.3}) {
    const OneContact one = vertex_over_body({0, 0, 0}, Vec3(0, 0, rises_m));
    const Ground ground = one_face();
    HeldContacts held({one.contact}, {}, ground.surface(1), one.V_t0, one.V_t1, kHeldStep, 1);
    CentralDifferencesOptions options;
    options.fields.gravity_m_s2 = -Vec3::UnitZ();
    options.step_s = 1.001 * kHeldStep / kSteps;
    const SpringSystem none({}, 1);
    Motion motion{one.V_t0.topRows(1), Positions::Zero(1, 3)};
    CentralDifferences(none, options).advance(motion, one.V_t0.topRows(1), std::array<double, 1>{1}, kHeldStep, &held);
    EXPECT_NEAR(motion.x(0, 2), kHeldThickness + rises_m, 1e-14);
    EXPECT_NEAR(motion.v(0, 2), rises_m / kHeldStep - kHeldStep / kSteps / 2, 1e-12) << "half a step of gravity";
    ASSERT_EQ(held.loads().vf.size(), 1U);
    if (rises_m > 0) continue;  // which it has learnt as well
    EXPECT_NEAR(held.loads().vf.front().acceleration_m_s2, 1, 0.01);
  }
}

TEST(SweptContacts, FollowTheBodyTheyLieOn) {
  OneContact one = vertex_over_body({0, 0, 0}, kHeldStep * Vec3(0.2, 0, 1));
  one.step();
  EXPECT_LT((one.v.row(0) - Eigen::RowVector3d(0.2, 0, 1)).norm(), 1e-14);
  EXPECT_NEAR(one.distance(), kHeldThickness, 1e-15);
}

}  // namespace selvage::sim::testbed
