#include "sim/dynamics/stage_contacts.h"

#include "sim/dynamics/implicit_dynamics.h"
#include "tests/property.h"
#include "tests/sim/dynamics/stage_contact_scene.h"

namespace selvage::sim::testbed {
namespace {

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

/// It is the sum of what the halves of a way change, wherever this leads: off each other, and out of the cone.
TEST(StageContacts, PropThePotentialDependsOnThePlaceAlone) {
  selvage::testing::check_property(300, 16, [] {
    OneStageContact one(pressed_pair(), 4, number_between(0, 1), number_between(0, 100));
    const Positions u = random_displacements(4, 0.2), step = random_displacements(4, 0.4);
    std::vector<double> whole, first, second;
    for (int round = 0; round < 2; ++round) {
      (void)one.forces(u);
      one.stage.changes(step, 1, whole);
      one.stage.changes(step, 0.5, first);
      (void)one.forces(u + 0.5 * step);
      one.stage.changes(step, 0.5, second);
      const double magnitude = std::abs(whole[0]) + std::abs(first[0]) + std::abs(second[0]);
      RC_CLASSIFY(magnitude > 0);
      RC_ASSERT(std::abs(first[0] + second[0] - whole[0]) <= 1e-12 * magnitude);
      (void)one.forces(u);
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

/// What is nearer than the thickness at the start stays as near at least, and what is farther comes as near as that.
TEST(StageContacts, PropOneThatBoreNothingActsOnlyBelowTheThicknessOrWhereItWas) {
  selvage::testing::check_property(300, 14, [] {
    const RandomPair pair = pressed_pair();
    OneStageContact one(pair, 4, number_between(0, 1), 0);
    const RepulsionContact& contact = one.held.contacts().front();
    const double room_m = std::max(0.0, contact.distance - kStageThickness);
    const auto approach = [&](double by_m) {
      const PairVectors moved = distribute(pair.interaction, -by_m * contact.normal);
      return OneStageContact::rows(moved);
    };
    RC_CLASSIFY(room_m > 0);
    RC_ASSERT(one.forces(Positions::Zero(4, 3)).isZero(0));
    RC_ASSERT(one.forces(approach(-0.1)).isZero(0));
    RC_ASSERT(one.forces(approach(room_m - 1e-9)).isZero(0));
    const Positions pressed = one.forces(approach(room_m + 1e-9));
    RC_ASSERT(!pressed.isZero(0));
    // It never pulls, nor remembers how far apart they were.
    (void)one.forces(approach(-0.1));
    (void)one.stage.update();
    RC_ASSERT(one.forces(approach(room_m + 1e-9)) == pressed);
    one.stage.finish();
    RC_ASSERT(one.held.count().repulsions == 0 && one.held.loads().empty());
  });
}

/// A contact that bears, and one that does not beside it: what is known of both.
TEST(StageContacts, WhatTheyBearIsThatOfAllOfThem) {
  Positions x(6, 3);
  x << 0, 0, kStageThickness, 5, 0, 0.3, -1, -1, 0, 1, -1, 0, 0, 1, 0, 9, 9, 9;
  const Mesh mesh = make_mesh(6, Faces{{2, 3, 4}});
  const SurfaceParts parts(mesh);
  const VertexFaces faces(mesh);
  const ContactTable properties(mesh, {}, {});
  const std::vector<double> inverse_mass{4, 2, 0, 0, 0, 0}, resistance_kg{1, 1};
  std::vector<RepulsionContact> contacts(2);
  for (const VertexId vertex : {0, 1}) {
    RepulsionContact& contact = contacts[static_cast<std::size_t>(vertex)];
    contact.first = vertex;
    contact.interaction = make_interaction(PairKind::kVf, {vertex, 2, 3, 4}, {1, 0.25, 0.25, 0.5}, inverse_mass);
    contact.normal = Vec3::UnitZ();
    contact.distance = x(vertex, 2);
    contact.properties.thickness_m = kStageThickness;
    contact.properties.friction_static = contact.properties.friction_kinetic = 0.5;
  }
  const double load_m_s2 = 8, load_m = load_m_s2 * kStageStep * kStageStep;
  HeldContacts held(contacts, {{{0, 0, load_m_s2}}, {}},
                    HeldSurface{mesh, parts, faces, properties, inverse_mass, 2, -Vec3::UnitZ()}, x, x, kStageStep, 1);
  StageContacts stage(held, x.topRows(2), inverse_mass, resistance_kg, {0, 1, kStageStep});
  Positions u = Positions::Zero(2, 3);
  stage.look(u);
  const ForceChange at_rest = stage.update();
  EXPECT_EQ(at_rest.change_m, 0);
  EXPECT_NEAR(at_rest.largest_m, load_m, 1e-15);
  u(0, 0) = 1e-3;
  stage.look(u);
  const ForceChange rubs = stage.update();
  EXPECT_NEAR(rubs.change_m, 4 * 1e-3, 1e-15) << "1 kg resists, of a mass of a quarter of that";
  EXPECT_NEAR(rubs.largest_m, load_m, 1e-15);
  EXPECT_TRUE(stage.forget());
  EXPECT_FALSE(stage.forget());
}

TEST(StageContacts, AChangeIsTakenAsAShareOfTheLargestOfAll) {
  EXPECT_EQ((ForceChange{0.5, 2}.share(0.1)), 0.25);
  EXPECT_EQ((ForceChange{2, 0.5}.share(0.1)), 1);
  EXPECT_EQ((ForceChange{0.1, 0}.share(0.1)), 0) << "not known that well";
}

/// How far bodies have come before the span, and how far they go in it, counts as if the cloth had gone the other way:
/// in the gap, and in the slip what is within the span.
TEST(StageContacts, PropOnlyMotionRelativeToBodiesCounts) {
  selvage::testing::check_property(300, 15, [] {
    const RandomPair pair = vertex_above_a_face();
    RepulsionContact contact = OneStageContact::contact(pair, 0.3);
    const ContactLoads loads{{{0, 0, number_between(0, 20), {number_between(-2, 2), number_between(-2, 2), 0}}}, {}};
    const double begin = number_between(0, 0.5), end = number_between(0.5, 1);
    const StageSpan span{begin, end, (end - begin) * kStageStep};
    const Vec3 way = vector_within(0.3), cloth_before = vector_within(0.1);
    OneStageContact moves(pair, 1, contact, loads, {way, span, cloth_before});
    OneStageContact rests(pair, 1, contact, loads, {Vec3::Zero(), span, cloth_before - begin * way});
    const Vec3 u = vector_within(0.2), u_beside = u - (end - begin) * way;
    for (int round = 0; round < 2; ++round) {
      const Positions forces = moves.forces(u.transpose()), beside = rests.forces(u_beside.transpose());
      RC_CLASSIFY(!forces.isZero(0));
      RC_ASSERT((forces - beside).norm() <= 1e-12 * (1 + beside.norm()));
      (void)moves.stage.update();
      (void)rests.stage.update();
    }
  });
}

/// Pushed as in MultipliersFindWhatHoldsAVertex, by 0.35 m too far and to the side.
TEST(StageContacts, StickAsFarAsTheStaticConeAndSlideUnderTheKineticOne) {
  const RandomPair pair = vertex_above_a_face();
  const double mass = 0.5, friction_static = 0.5, friction_kinetic = 0.2;
  RepulsionContact contact = OneStageContact::contact(pair, friction_static);
  contact.properties.friction_kinetic = friction_kinetic;
  for (const double aside_m : {0.17, 0.18}) {  // the border of the cone is at 0.175
    SCOPED_TRACE(aside_m);
    OneStageContact one(pair, 1, contact, {}, {});
    const auto find = [&] {
      Vec3 u = Vec3::Zero();
      double left = 1;
      for (int round = 0; round < 60 && left > 1e-12; ++round) {
        for (int i = 0; i < 200; ++i) {
          const Vec3 force = one.forces(u.transpose()).row(0);
          u += (force - mass * (u - Vec3(aside_m, 0, -0.4))) / (4 * mass);
        }
        left = one.stage.update().share(0);
      }
      return u;
    };
    const bool slides = aside_m > friction_static * 0.35;
    EXPECT_NEAR(find().x(), slides ? aside_m - friction_static * 0.35 : 0, 1e-9);
    OneStageContact known_no_better(pair, 1, contact, {}, {});
    (void)known_no_better.forces(Eigen::RowVector3d(aside_m, 0, -0.4));
    (void)known_no_better.stage.update();
    EXPECT_FALSE(known_no_better.stage.let_slide(1)) << "it does, by less than is known";
    EXPECT_EQ(one.stage.let_slide(1e-10), slides);
    EXPECT_FALSE(one.stage.let_slide(1e-10)) << "it does already";
    EXPECT_NEAR(find().x(), slides ? aside_m - friction_kinetic * 0.35 : 0, 1e-9);
    one.stage.finish();
    const ContactLoad load = one.held.loads().vf.front();
    const double borne_m_s2 = Vec3(load.friction_m_s2.data()).norm();
    EXPECT_NEAR(borne_m_s2 * kStageStep * kStageStep, slides ? friction_kinetic * 0.35 : aside_m, 1e-9);
    (void)one.stage.forget();
    EXPECT_NEAR(find().x(), slides ? aside_m - friction_static * 0.35 : 0, 1e-9) << "it begins again";
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

/// In steps of backward Euler it is after the first one where the body lets it be, and in the last one it has the
/// body's velocity and is borne.
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
