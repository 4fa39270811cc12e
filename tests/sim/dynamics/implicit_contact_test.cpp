// What the implicit solver does with contacts, beside cloth and pins that have none.
#include <vector>

#include "sim/dynamics/implicit_dynamics.h"
#include "tests/sim/dynamics/stage_contact_scene.h"

namespace selvage::sim::testbed {

TEST(StageContacts, WhatLiesOnABodyGoesWithIt) {
  const RandomPair pair = vertex_above_a_face();
  const double gravity_m_s2 = 10;
  for (const int steps : {1, 2, 5}) {
    SCOPED_TRACE(steps);
    const Vec3 way(0.01, -0.005, 0.1);
    OneStageContact one(pair, 1, OneStageContact::contact(pair, 1), {}, {way});
    ImplicitDynamicsOptions options;
    options.fields.gravity_m_s2 = {0, 0, -gravity_m_s2};
    options.step_s = 1.001 * kStageStep / steps;
    const SpringSystem none({}, 1);
    Motion motion{one.x.topRows(1), Positions::Zero(1, 3)};
    motion.v(0, 2) = -1;
    const DynamicsReport report =
        ImplicitDynamics(none, options).advance(motion, one.x.topRows(1), one.inverse_mass, kStageStep, &one.held);
    EXPECT_EQ(report.unconverged, 0);
    EXPECT_EQ(report.solves, steps);
    const double known_m = 1e-4;  // what contacts bear is found to a ten-thousandth
    EXPECT_NEAR(motion.x(0, 2), kStageThickness + way.z(), known_m);
    if (steps == 1) {
      EXPECT_NEAR(motion.v(0, 2), (motion.x(0, 2) - 0.3) / kStageStep, 1e-7);
    } else {
      EXPECT_LT((motion.v.row(0).transpose() - way / kStageStep).norm(), steps * known_m / kStageStep);
      ASSERT_EQ(one.held.loads().vf.size(), 1U);
      const double load_m_s2 = one.held.loads().vf.front().acceleration_m_s2;
      if (steps == 5) {
        EXPECT_NEAR(load_m_s2, gravity_m_s2, 0.01 * gravity_m_s2);
      }
    }
  }
}

/// Two vertices on a spring swing beside the one that lies on the face, at their own accuracy.
TEST(StageContacts, ClothThatMeetsNothingTakesTwoStagesBesideOthersThatDo) {
  Positions x(6, 3);
  x << 0, 0, 0.3, 5, 0, 0, 6.1, 0, 0, -1, -1, 0, 1, -1, 0, 0, 1, 0;
  const Mesh mesh = make_mesh(6, Faces{{3, 4, 5}});
  const SurfaceParts parts(mesh);
  const VertexFaces faces(mesh);
  const ContactTable properties(mesh, {}, {});
  const std::vector<double> inverse_mass{2, 2, 3, 0, 0, 0};
  RepulsionContact contact;
  contact.interaction = make_interaction(PairKind::kVf, {0, 3, 4, 5}, {1, 0.25, 0.25, 0.5}, inverse_mass);
  contact.normal = Vec3::UnitZ();
  contact.distance = 0.3;
  contact.properties.thickness_m = kStageThickness;
  HeldContacts held({contact}, {}, HeldSurface{mesh, parts, faces, properties, inverse_mass, 3, -Vec3::UnitZ()}, x, x,
                    kStageStep, 1);
  const SpringSystem springs({Spring{1, 2, SpringKind::kStructural, 1, 20, 0}}, 3);
  ImplicitDynamicsOptions options;
  options.strain = {.strain = 0, .strain_rate = 0};
  options.step_s = kStageStep / 3;
  Motion alone{x.topRows(3), Positions::Zero(3, 3)};
  alone.v(0, 2) = -1;
  alone.v(2, 1) = 0.3;
  Motion beside = alone;
  const PositionsRef script = x.topRows(3);
  ImplicitDynamics(springs, options).advance(alone, script, inverse_mass, kStageStep);
  ImplicitDynamics(springs, options).advance(beside, script, inverse_mass, kStageStep, &held);
  EXPECT_NEAR(beside.x(0, 2), kStageThickness, 1e-4);
  EXPECT_NEAR(alone.x(0, 2), 0.3 - kStageStep, 1e-7);
  EXPECT_LT((beside.x - alone.x).bottomRows(2).norm(), 1e-8);
  EXPECT_LT((beside.v - alone.v).bottomRows(2).norm(), 1e-7);
}

/// A pin, a vertex on a spring at it, and a body below: in a frame that moves with all of them they do the same.
TEST(StageContacts, PinsGoOnWhileOthersAreInContact) {
  const auto moved = [](const Vec3& drift_m, double limit) {
    Positions x(5, 3);
    x << 0, 0, 0.3, 1, 0, 0.3, -1, -1, 0, 1, -1, 0, 0, 1, 0;
    const Positions x_t1 = x.rowwise() + drift_m.transpose();
    const Mesh mesh = make_mesh(5, Faces{{2, 3, 4}});
    const SurfaceParts parts(mesh);
    const VertexFaces faces(mesh);
    const ContactTable properties(mesh, {}, {});
    const std::vector<double> inverse_mass{2, 0, 0, 0, 0};
    RepulsionContact contact;
    contact.interaction = make_interaction(PairKind::kVf, {0, 2, 3, 4}, {1, 0.25, 0.25, 0.5}, inverse_mass);
    contact.normal = Vec3::UnitZ();
    contact.distance = 0.3;
    contact.properties.thickness_m = kStageThickness;
    HeldContacts held({contact}, {}, HeldSurface{mesh, parts, faces, properties, inverse_mass, 2, -Vec3::UnitZ()}, x,
                      x_t1, kStageStep, 1);
    const SpringSystem springs({Spring{0, 1, SpringKind::kStructural, 1, 3, 0.1}}, 2);
    ImplicitDynamicsOptions options;
    options.strain = {.strain = limit, .strain_rate = 0};
    options.step_s = kStageStep / 2;
    Motion motion{x.topRows(2), Positions::Zero(2, 3)};
    motion.v.row(0) << -1, 0, -1;
    motion.v.rowwise() += drift_m.transpose() / kStageStep;
    ImplicitDynamics(springs, options).advance(motion, x_t1.topRows(2), inverse_mass, kStageStep, &held);
    motion.x.rowwise() -= drift_m.transpose();
    motion.v.rowwise() -= drift_m.transpose() / kStageStep;
    return motion;
  };
  const Motion at_rest = moved(Vec3::Zero(), 0), drifts = moved({0.4, -0.3, 0.2}, 0);
  EXPECT_NEAR(at_rest.x(0, 2), kStageThickness, 1e-4);
  EXPECT_GT((at_rest.x.row(1) - at_rest.x.row(0)).norm(), 1.08);
  EXPECT_LT((drifts.x - at_rest.x).norm(), 1e-4);
  EXPECT_LT((drifts.v - at_rest.v).norm(), 2e-3);
  const Motion limited = moved(Vec3::Zero(), 0.05);
  EXPECT_NEAR((limited.x.row(1) - limited.x.row(0)).norm(), 1.05, 1e-3);
}

}  // namespace selvage::sim::testbed
