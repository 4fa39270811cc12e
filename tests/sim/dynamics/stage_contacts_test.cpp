#include "sim/dynamics/stage_contacts.h"

#include "sim/dynamics/implicit_dynamics.h"
#include "tests/property.h"
#include "tests/sim/mechanics.h"

namespace selvage::sim::testbed {
namespace {

constexpr double kStageThickness = 0.25, kStageStep = 0.125;

/// One contact of four vertices, of which the first `cloth_count` are cloth, and what a stage adds for it.
struct OneStageContact {
  Mesh mesh = make_mesh(4, Faces{{1, 2, 3}});
  SurfaceParts parts{mesh};
  VertexFaces faces{mesh};
  ContactTable properties{mesh, {}, {}};
  std::vector<double> inverse_mass, resistance_kg;
  Positions x, x_t1;
  HeldContacts held;
  StageContacts stage;

  OneStageContact(const RandomPair& pair, Eigen::Index cloth_count, double friction, double load_m_s2,
                  bool is_beyond = false)
      : OneStageContact(pair, cloth_count, friction, ContactLoads{{{0, 0, load_m_s2}}, {}}, is_beyond) {}
  OneStageContact(const RandomPair& pair, Eigen::Index cloth_count, double friction, const ContactLoads& loads,
                  bool is_beyond = false)
      : inverse_mass(pair.inverse_mass.begin(), pair.inverse_mass.end()),
        resistance_kg(resistances(pair)),
        x(rows(pair.x_t0)),
        x_t1(x),
        held({contact(pair, friction, is_beyond)}, loads,
             HeldSurface{mesh, parts, faces, properties, inverse_mass, cloth_count, -Vec3::UnitZ()}, x, x_t1,
             kStageStep, 1),
        stage(held, x.topRows(cloth_count), inverse_mass, resistance_kg, {0, 1, kStageStep}) {}

  static std::vector<double> resistances(const RandomPair& pair) {
    std::vector<double> result;
    for (const double w : pair.inverse_mass) result.push_back(w > 0 ? 2 / w : 1);
    return result;
  }
  static Positions rows(const PairVectors& vectors) {
    Positions result(4, 3);
    for (Eigen::Index i = 0; i < 4; ++i) result.row(i) = vectors[static_cast<std::size_t>(i)];
    return result;
  }
  static RepulsionContact contact(const RandomPair& pair, double friction, bool is_beyond = false) {
    RepulsionContact result = contact_of(pair, kStageThickness);
    result.is_beyond = is_beyond;
    result.properties.friction_static = result.properties.friction_kinetic = friction;
    return result;
  }
  [[nodiscard]] Positions forces(const Positions& u) {
    stage.look(u);
    Positions result(u.rows(), 3);
    for (Eigen::Index i = 0; i < u.rows(); ++i) result.row(i) = stage.force_at(i);
    return result;
  }
};

Positions random_displacements(Eigen::Index count, double bound) {
  Positions result(count, 3);
  for (Eigen::Index i = 0; i < count; ++i) result.row(i) = vector_within(bound);
  return result;
}

RandomPair pressed_pair() {
  const RandomPair pair = random_contact(number_between(0.5, 1.5) * kStageThickness);
  RC_PRE(lever_share(pair.interaction) == 1);
  return pair;
}

/// By 0.3 m; the face is a body's.
RandomPair vertex_above_a_face() {
  RandomPair pair;
  pair.inverse_mass = {2, 0, 0, 0};
  pair.interaction = make_interaction(PairKind::kVf, {0, 1, 2, 3}, {1, 0.25, 0.25, 0.5}, pair.inverse_mass);
  pair.x_t0 = {Vec3(0, 0, 0.3), Vec3(-1, -1, 0), Vec3(1, -1, 0), Vec3(0, 1, 0)};
  return pair;
}

/// What the matrix makes of a step.
Positions product_of(const StageContacts& stage, const Positions& step) {
  LaneVectors in_lanes, product;
  in_lanes.copy(step);
  product.resize(step.rows());
  stage.add_product(in_lanes, product);
  Positions result(step.rows(), 3);
  product.copy_to(result);
  return result;
}

}  // namespace

/// Forces are the slope of the potential, which is convex, and the matrix is the slope of the forces.
TEST(StageContacts, PropForcesAndMatrixAreThoseOfOneConvexPotential) {
  selvage::testing::check_property(500, 11, [] {
    OneStageContact one(pressed_pair(), 4, number_between(0, 1), number_between(0, 100));
    const Positions u = random_displacements(4, 0.2), step = random_displacements(4, 1e-4);
    for (int round = 0; round < 3; ++round) {  // the cone opens with what the contact bears
      const Positions before = one.forces(u);
      std::vector<double> change;
      one.stage.changes(step, 1, change);
      RC_ASSERT(change.size() == 1u);
      const Positions predicted = product_of(one.stage, step);
      for (Eigen::Index i = 0; i < 4; ++i) {
        SymmetricBlock block{};
        one.stage.add_diagonal(i, block);
        RC_ASSERT(block[0] >= 0 && block[3] >= 0 && block[5] >= 0);
        Positions alone = Positions::Zero(4, 3);
        alone.row(i) = step.row(i);
        const Positions product = product_of(one.stage, alone);
        const Eigen::RowVector3d by_block(block[0] * step(i, 0) + block[1] * step(i, 1) + block[2] * step(i, 2),
                                          block[1] * step(i, 0) + block[3] * step(i, 1) + block[4] * step(i, 2),
                                          block[2] * step(i, 0) + block[4] * step(i, 1) + block[5] * step(i, 2));
        RC_ASSERT((product.row(i) - by_block).norm() <= 1e-12 * (by_block.norm() + product.norm()));
      }
      const Positions after = one.forces(u + step);
      const Positions predicted_back = product_of(one.stage, step);
      // Convex: the change lies between what the slopes at both ends promise.
      const double from_start = -before.cwiseProduct(step).sum(), from_end = -after.cwiseProduct(step).sum();
      const double rounding = 1e-12 * (std::abs(from_start) + std::abs(from_end));
      RC_ASSERT(change[0] >= from_start - rounding);
      RC_ASSERT(change[0] <= from_end + rounding);
      // No kink on the way: the forces change as the matrix says.
      if ((predicted_back - predicted).norm() <= 1e-2 * predicted.norm()) {
        RC_ASSERT((before - after - predicted).norm() <= 2e-2 * predicted.norm() + 1e-12 * before.norm());
      }
      RC_ASSERT(one.forces(u) == before);
      (void)one.stage.update();
    }
  });
}

TEST(StageContacts, PropForcesKeepBothMomenta) {
  selvage::testing::check_property(500, 12, [] {
    const RandomPair pair = pressed_pair();
    OneStageContact one(pair, 4, 0.5, number_between(1, 100));
    for (int round = 0; round < 2; ++round) {
      const Positions forces = one.forces(random_displacements(4, 0.2));
      Vec3 torque = Vec3::Zero();
      for (Eigen::Index i = 0; i < 4; ++i) torque += Vec3(one.x.row(i)).cross(Vec3(forces.row(i)));
      RC_ASSERT(forces.colwise().sum().norm() <= 1e-12 * forces.norm());
      RC_ASSERT(torque.norm() <= 1e-11 * forces.norm() * one.x.norm());
      (void)one.stage.update();
    }
  });
}

/// A vertex of 0.5 kg over a face that does not move, pushed with (0.1, 0, -0.4) m: the multipliers find the load, and
/// friction takes its share of it.
TEST(StageContacts, MultipliersFindWhatHoldsAVertex) {
  const RandomPair pair = vertex_above_a_face();
  const Vec3 push(0.1, 0, -0.4);  // of which 0.35 m is too much
  const double mass = 0.5;
  for (const double friction : {0.0, 0.2, 0.5}) {
    OneStageContact one(pair, 1, friction, 0);
    Vec3 u = Vec3::Zero();
    double left = 1;
    for (int round = 0; round < 60 && left > 1e-12; ++round) {
      // The minimum of mass/2 |u - push|^2 and the contact's term: by gradient descent, as its matrix is at most 2 m.
      for (int i = 0; i < 200; ++i) {
        const Vec3 force = one.forces(u.transpose()).row(0);
        u += (force - mass * (u - push)) / (4 * mass);
      }
      left = one.stage.update().share(0);
    }
    EXPECT_NEAR(u.z(), -(0.3 - kStageThickness), 1e-9) << friction;
    EXPECT_NEAR(u.x(), std::max(0.0, 0.1 - friction * 0.35), 1e-9) << friction;
    one.stage.finish();
    EXPECT_NEAR(one.held.loads().vf.front().acceleration_m_s2, 0.35 / (kStageStep * kStageStep), 1e-6);
    EXPECT_EQ(one.held.count().repulsions, 1);
    EXPECT_EQ(one.held.count().frictions, friction > 0 ? 1 : 0);
  }
}

TEST(StageContacts, OneBeyondWhatIsStraightDoesNotAct) {
  const Eigen::RowVector3d into_it(0.1, 0, -0.4);
  EXPECT_GT(OneStageContact(vertex_above_a_face(), 1, 0.2, 0).forces(into_it)(0, 2), 0);
  EXPECT_TRUE(OneStageContact(vertex_above_a_face(), 1, 0.2, 0, true).forces(into_it).isZero(0));
}

/// What was found for one stage is the next one's first guess, friction and edges as well: nothing is left to find
/// where the cloth is pushed alike. Cloth at rest is pushed alike in every step.
TEST(StageContacts, PropBeginsWithWhatItBoreLast) {
  selvage::testing::check_property(300, 13, [] {
    const RandomPair pair = pressed_pair();
    const double friction = number_between(0.1, 1);
    const Positions u = random_displacements(4, 0.2);
    OneStageContact one(pair, 4, friction, 0);
    for (int round = 0; round < 3; ++round) {
      (void)one.forces(u);
      (void)one.stage.update();
    }
    one.stage.finish();
    const ContactLoads loads = one.held.loads();
    RC_PRE(!loads.empty());
    RC_ASSERT(loads.ee.empty() == (OneStageContact::contact(pair, friction).kind == PairKind::kVf));
    OneStageContact next(pair, 4, friction, loads);
    // Where nothing has moved, a contact asks for what it bears and for its gap.
    const Positions begun = next.forces(Positions::Zero(4, 3)), bore = one.forces(Positions::Zero(4, 3));
    RC_ASSERT((begun - bore).norm() <= 1e-12 * bore.norm());
    RC_ASSERT(next.stage.forget());
    RC_ASSERT(!next.stage.forget());
    RC_ASSERT(next.forces(u) == OneStageContact(pair, 4, friction, 0).forces(u));
  });
}

/// Its velocity is where it went: that of its forces, which balance nothing, took two sheets of 60 kN/m that met at 5
/// m/s to 3.6 times the energy that they had.
TEST(StageContacts, WhatWasNotSolvedGoesNoFartherThanItDid) {
  RandomPair pair;
  pair.inverse_mass = {1e10, 1e10, 1e10, 1e10};
  pair.interaction = make_interaction(PairKind::kVf, {0, 1, 2, 3}, {1, 0.25, 0.25, 0.5}, pair.inverse_mass);
  pair.x_t0 = {Vec3(0, 0, 0.3), Vec3(-1, -1, 0), Vec3(1, -1, 0), Vec3(0, 1, 0)};
  OneStageContact one(pair, 4, 0.5, 0);
  const SpringSystem springs({Spring{1, 2, SpringKind::kStructural, 1, 1e300, 0}}, 4);  // forces beyond any double
  ImplicitDynamicsOptions options;
  options.step_s = kStageStep;
  Motion motion{one.x, Positions::Constant(4, 3, 0.1)};
  const DynamicsReport report =
      ImplicitDynamics(springs, options).advance(motion, one.x, one.inverse_mass, kStageStep, &one.held);
  EXPECT_EQ(report.unconverged, 1);
  EXPECT_TRUE(motion.v.allFinite());
  EXPECT_EQ(motion.v, Positions((motion.x - one.x) / kStageStep));
  EXPECT_TRUE(one.held.loads().empty());
}

/// The only corner that can move has a small weight: left to the collision step, and its load does not wait for later.
TEST(StageContacts, AContactOfALimitedLeverKeepsNoLoad) {
  for (const double weight : {0.5, 0.01}) {
    RandomPair pair;
    pair.inverse_mass = {0, 1, 0, 0};
    pair.interaction = make_interaction(PairKind::kVf, {0, 1, 2, 3}, {1, weight, 0.5, 0.5 - weight}, pair.inverse_mass);
    pair.x_t0 = {Vec3::Zero(), Vec3(-1, -1, 0), Vec3(1, -1, 0), Vec3(0, 1, 0)};
    pair.x_t0[0] = relative(pair.interaction, pair.x_t0) * -1 + 0.2 * Vec3::UnitZ();
    const bool has_term = lever_share(pair.interaction) == 1;
    EXPECT_EQ(has_term, weight == 0.5);
    OneStageContact one(pair, 4, 0.5, 7);
    (void)one.forces(Positions::Zero(4, 3));
    (void)one.stage.update();
    one.stage.finish();
    EXPECT_EQ(one.held.loads().vf.size(), has_term ? 1U : 0U);
  }
}

}  // namespace selvage::sim::testbed
