// Where contacts that are swept over are: on which face, seen from which side, and when they end.
#include <gtest/gtest.h>

#include "tests/sim/dynamics/swept_contact_scenes.h"

namespace selvage::sim::testbed {

TEST(SweptContacts, DoNotActWhereThePointsAreOnVerticesThatCannotMove) {
  // The body's vertex has come to be over a held corner of the face; the contact was that of the middle.
  Positions V(4, 3);
  V << 0, 2, 0, -2, 0, 0, 2, 0, 0, 2, 0, kHeldThickness / 2;
  RepulsionContact contact;
  contact.interaction =
      make_interaction(PairKind::kVf, {3, 0, 1, 2}, {1, 1.0 / 3, 1.0 / 3, 1.0 / 3}, std::array<double, 4>{1, 0, 0, 0});
  contact.x_t0 = gather(contact.interaction, V);
  contact.normal = Vec3::UnitZ();
  contact.properties.thickness_m = kHeldThickness;
  const Ground ground(Faces{{0, 1, 2}}, {1, 0, 0, 0});
  for (const double load_m_s2 : {0.0, 5.0}) {
    LaneVectors x, v;
    x.copy(V.topRows(3));
    v.resize(3);
    v.set_zero();
    v.row(0) = Eigen::RowVector3d(0, 0, 1);
    x.row(0) += kHeldStep * v.row(0);
    Swept held({contact}, {{{0, 0, load_m_s2}}, {}}, ground.surface(3), V, V, kHeldStep, 1);
    act(held, {kHeldStep, 1, x, v});
    EXPECT_EQ(Eigen::RowVector3d(v.row(0)), Eigen::RowVector3d(0, 0, 1));
    EXPECT_EQ(held.count().repulsions, 0);
  }
}

TEST(SweptContacts, AreGivenOnAsTheyWereLastLookedAt) {
  // It slides over the border of the face at y = -2, and is pressed there: along the line to the border.
  OneContact one = vertex_over_body({0, -2.1 / kHeldStep, 0});
  const std::vector<RepulsionContact> contacts{one.contact};
  const Ground ground = one_face();
  Swept held(contacts, {}, ground.surface(1), one.V_t0, one.V_t1, 2 * kHeldStep, 1);
  EXPECT_EQ(held.taken().front().normal, one.contact.normal);
  one.x.row(0) += kHeldStep * one.v.row(0);
  act(held, {kHeldStep, 0.5, one.x, one.v});
  one.v.row(0) = Eigen::RowVector3d(0, 0, -1);
  one.x.row(0) += kHeldStep * one.v.row(0);
  act(held, {kHeldStep, 1, one.x, one.v});
  const RepulsionContact now = held.taken().front();
  EXPECT_LT((now.normal - Vec3(0, -0.1, kHeldThickness).normalized()).norm(), 1e-12);
  EXPECT_NEAR(now.distance, (Vec3(0, 0, kHeldThickness) - Vec3(0, -2, 0)).dot(now.normal), 1e-12);
  const Vec3 moved = one.x.row(0) - one.V_t0.row(0);
  EXPECT_GE(now.distance + moved.dot(now.normal), kHeldThickness - 1e-12);
}

TEST(SweptContacts, GoOnToTheFaceOnWhichAVertexSlides) {
  // Over the border, then down; on a body at rest, and on one that goes on by `drift_m` in every step.
  using Case = std::pair<double, double>;
  for (const auto& [to_x, drift_m] : {Case{0, 0}, {1.5, 0}, {-2.5, 0}, {0, 2.4}, {1.5, -2.4}, {-2.5, 2.4}}) {
    SCOPED_TRACE(::testing::Message() << to_x << " m, on a body that goes on by " << drift_m);
    const Eigen::RowVector3d drift(0, drift_m, 0);
    TwoFaces scene;
    OneContact& one = scene.one;
    const std::vector<RepulsionContact> contacts{one.contact};
    const Positions V_t1 = scene.V.rowwise() + 3 * drift;
    Swept held(contacts, {}, scene.ground.surface(1), scene.V, V_t1, 3 * kHeldStep, 1);
    move_and_hold(one, held, (Eigen::RowVector3d(to_x, -2.5, 0) + drift) / kHeldStep, 1.0 / 3);
    for (const double share : {2.0 / 3, 1.0}) {
      move_and_hold(one, held, Eigen::RowVector3d(0, 0, -0.5) + drift / kHeldStep, share);
    }
    if (to_x == -2.5) {  // beside both faces: 0.6 m to the border, nothing holds it
      EXPECT_EQ(held.count().repulsions, 0);
      continue;
    }
    EXPECT_EQ(held.count().repulsions, 1);
    EXPECT_NEAR(one.x.row(0).z(), kHeldThickness, 1e-15);
    const RepulsionContact now = held.taken().front();
    EXPECT_EQ(now.second, 1);
    EXPECT_EQ(now.second_t0, 0) << "the pair that was met";
    EXPECT_EQ(now.interaction.vertices, (std::array<VertexId, 4>{0, 2, 1, 4}));
    EXPECT_NEAR(now.distance, kHeldThickness, 1e-15);
    ASSERT_EQ(held.loads().vf.size(), 1U);
    EXPECT_EQ(held.loads().vf[0].second, 1);
  }
}

// Two faces of cloth that meet at y = 0 and rise from there sink on a vertex on a ridge along y, below the first or, as
// they have passed over it, the second. Where the ridge does not go on to below the nearest point nothing of this pair
// holds them.
TEST(SweptContacts, OfAVertexOnARidgeActAcrossItAsFarAsItGoes) {
  Positions V(7, 3);
  V << 0, -4, kHeldThickness + 0.4, -2, 0, kHeldThickness, 2, 0, kHeldThickness, 0, 4, kHeldThickness + 0.8,  // cloth
      0, -1, 0, 0, -10, 0, 0, 10, 0;
  const Ground ground(Faces{{0, 1, 2}, {2, 1, 3}}, {1, 1, 1, 1, 0, 0, 0});
  RepulsionContact contact;
  contact.first = 4;
  contact.interaction = make_interaction(PairKind::kVf, {4, 0, 1, 2}, {1, 0.25, 0.375, 0.375}, ground.inverse_mass);
  contact.properties.thickness_m = kHeldThickness;
  contact.x_t0 = gather(contact.interaction, V);
  contact.normal = -Vec3::UnitZ();
  using Case = std::pair<double, double>;
  for (const auto& [extent_m, passes_m] : {Case{9, 2}, Case{9, 0}, Case{0, 2}, Case{0, 0}}) {
    SCOPED_TRACE(::testing::Message() << extent_m << " m, passes over by " << passes_m);
    contact.straight.parts[StraightFeature::kWithin] = {
        StraightSurface::Kind::kLine, {5, 6, 0, 0}, {extent_m, extent_m}};
    LaneVectors x, v;
    x.copy(V.topRows(4));
    v.resize(4);
    Swept held({contact}, {}, ground.surface(4), V, V, 2 * kHeldStep, 1);
    for (const Eigen::RowVector3d& way : {Eigen::RowVector3d(0, -passes_m, 0), Eigen::RowVector3d(0, 0, -0.3)}) {
      for (Eigen::Index row = 0; row < 4; ++row) {
        v.row(row) = way / kHeldStep;
        x.row(row) += way;
      }
      act(held, {kHeldStep, way.z() == 0 ? 0.5 : 1, x, v});
    }
    EXPECT_EQ(held.count().repulsions, extent_m > 0 ? 1 : 0);
    for (Eigen::Index row = 0; row < 4; ++row) EXPECT_EQ(v.row(row).y(), 0) << row;
    const RepulsionContact now = held.taken().front();
    EXPECT_EQ(now.is_beyond, extent_m == 0);
    if (now.is_beyond) continue;
    EXPECT_EQ(now.second, passes_m > 0 ? 1 : 0);
    EXPECT_LT((now.normal + Vec3::UnitZ()).norm(), 1e-15);
  }
}

TEST(SweptContacts, WhatWasBeyondIsSeenFromWhereItIsOnceItIsOver) {
  // Cloth slides along a ridge and sinks on a vertex of it; as it was when the step began it would be taken for what
  // has passed through.
  Positions V(6, 3);
  V << 0, -4, 0.15, -2, 4, 0.15, 2, 4, 0.15, 0, 0, 0, 0, -10, 0, 0, 10, 0;
  const Ground ground(Faces{{0, 1, 2}}, {1, 1, 1, 0, 0, 0});
  for (const bool was_beyond : {false, true}) {
    RepulsionContact contact;
    contact.first = 3;
    contact.interaction = make_interaction(PairKind::kVf, {3, 0, 1, 2}, {1, 0.5, 0.25, 0.25}, ground.inverse_mass);
    contact.properties.thickness_m = kHeldThickness;
    contact.x_t0 = gather(contact.interaction, V);
    contact.normal = Vec3(0, -1, 0.1).normalized();
    contact.straight.parts[StraightFeature::kWithin] = {StraightSurface::Kind::kLine, {4, 5, 0, 0}, {9, 9}};
    contact.is_beyond = was_beyond;
    LaneVectors x, v;
    x.copy(V.topRows(3));
    v.resize(3);
    for (Eigen::Index row = 0; row < 3; ++row) {
      v.row(row) = Eigen::RowVector3d(0, -1, -0.5);
      x.row(row) += kHeldStep * v.row(row);
    }
    Swept held({contact}, {}, ground.surface(3), V, V, kHeldStep, 1);
    act(held, {kHeldStep, 1, x, v});
    const RepulsionContact now = held.taken().front();
    EXPECT_FALSE(now.is_beyond);
    EXPECT_EQ(now.normal, was_beyond ? Vec3(-Vec3::UnitZ()) : contact.normal);
  }
}

TEST(SweptContacts, WhatHasPassedThroughBesideTheBorderIsHeldAsItWas) {
  // Below the second face: nearer than the thickness to it, and nearer or farther than that to the border of the first.
  for (const double y : {-2.1, -2.35, -2.6}) {
    SCOPED_TRACE(y);
    TwoFaces scene;
    OneContact& one = scene.one;
    scene.V.row(0) = Eigen::RowVector3d(0, y, -0.1);
    one.x.row(0) = scene.V.row(0);
    const std::vector<RepulsionContact> contacts{one.contact};
    Swept held(contacts, {}, scene.ground.surface(1), scene.V, scene.V, kHeldStep, 1);
    move_and_hold(one, held, {0, 0, -1}, 1);
    EXPECT_EQ(one.v.row(0), Eigen::RowVector3d(0, 0, 0));
    EXPECT_EQ(held.taken().front().normal, Vec3::UnitZ());
  }
}

TEST(SweptContacts, DoNotGoOnToAFaceThatCannotMove) {
  // A vertex of a body slides from the face with a free corner over one whose corners are all held, and comes through.
  Positions V(5, 3), V_t1(5, 3);
  V << 0, 1, 0, -1, 0, 0, 1, 0, 0, 0, -1, 0, 0, 0.3, 0.2;
  V_t1 = V;
  V_t1.row(4) << 0, -0.6, -0.1;
  const Ground ground(Faces{{0, 1, 2}, {2, 1, 3}}, {1, 0, 0, 0, 0});
  RepulsionContact contact;
  contact.first = 4;
  contact.interaction = make_interaction(PairKind::kVf, {4, 0, 1, 2}, {1, 0.3, 0.35, 0.35}, ground.inverse_mass);
  contact.normal = Vec3::UnitZ();
  contact.properties.thickness_m = kHeldThickness;
  LaneVectors x, v;
  x.copy(V.topRows(4));
  v.resize(4);
  v.set_zero();
  constexpr int kSteps = 6;
  Swept held({contact}, {}, ground.surface(4), V, V_t1, kSteps * kHeldStep, 1);
  for (int step = 1; step <= kSteps; ++step) {
    for (Eigen::Index i = 0; i < 4; ++i) x.row(i) += kHeldStep * v.row(i);
    act(held, {kHeldStep, double(step) / kSteps, x, v});
    for (Eigen::Index i = 1; i < 4; ++i) EXPECT_EQ(x.row(i), V.row(i)) << step;
    EXPECT_TRUE(x.row(0).allFinite()) << step;
    EXPECT_GT(held.taken().front().mobility, 0) << step;
  }
}

TEST(SweptContacts, OneThatSlidesOnToAVertexOfAnotherActsAfterIt) {
  // Two vertices over a strip of three faces; the first comes to the face in the middle, which shares a corner with the
  // one below the second. Alone, the second and then the first, they do the same, bit by bit.
  Positions V(8, 3);
  V << 0.9, 0, 0.2, 2.6, 0, 0.2, 0, 0, 0, 1, 1, 0, 1, -1, 0, 2, 0, 0, 3, 1, 0, 3, -1, 0;
  const Ground ground(Faces{{2, 4, 3}, {3, 4, 5}, {5, 7, 6}}, std::vector<double>(8, 1.0));
  const auto contact_on = [&](VertexId vertex, FaceId face, const std::array<VertexId, 3>& f) {
    RepulsionContact contact;
    contact.first = vertex;
    contact.second = contact.second_t0 = face;
    contact.interaction =
        make_interaction(PairKind::kVf, {vertex, f[0], f[1], f[2]}, {1, 0.2, 0.4, 0.4}, ground.inverse_mass);
    contact.normal = Vec3::UnitZ();
    contact.properties.thickness_m = kHeldThickness;
    return contact;
  };
  const RepulsionContact first = contact_on(0, 0, {2, 4, 3}), second = contact_on(1, 2, {5, 7, 6});
  const auto velocities = [&](const std::vector<std::vector<RepulsionContact>>& one_after_the_other) {
    LaneVectors x, v;
    x.copy(V);
    x.row(0).x() += 0.4;  // in a step before
    v.resize(8);
    v.set_zero();
    for (const VertexId i : {0, 1}) {
      v.row(i).z() = -0.5;
      x.row(i) += kHeldStep * v.row(i);
    }
    std::int64_t repulsions = 0;
    for (const std::vector<RepulsionContact>& contacts : one_after_the_other) {
      Swept held(contacts, {}, ground.surface(8), V, V, 2 * kHeldStep, 1);
      act(held, {kHeldStep, 1, x, v});
      repulsions += held.count().repulsions;
    }
    EXPECT_EQ(repulsions, 2);
    Positions result(8, 3);
    v.copy_to(result);
    return result;
  };
  EXPECT_EQ(velocities({{first, second}}), velocities({{second}, {first}}));
  EXPECT_NE(velocities({{first}, {second}}), velocities({{second}, {first}}));
}

TEST(SweptContacts, OneThatSlidesOnLeavesThoseOfItsPackAsTheyAre) {
  // Two vertices over a flat body of two faces: the first has come over the border and falls, the second falls more
  // than the load that it begins with bears. Beside the first it does what it does alone.
  Positions V(6, 3);
  V << 0, -2.2, kHeldThickness, 0.2, 0, kHeldThickness, -2, -2, 0, 2, -2, 0, 0, 4, 0, 0, -6, 0;
  const Ground ground(Faces{{2, 3, 4}, {3, 2, 5}}, {1, 1, 0, 0, 0, 0});
  const auto contact_of = [&](VertexId vertex) {
    RepulsionContact contact;
    contact.first = vertex;
    contact.interaction =
        make_interaction(PairKind::kVf, {vertex, 2, 3, 4}, {1, 1.0 / 3, 1.0 / 3, 1.0 / 3}, ground.inverse_mass);
    contact.normal = Vec3::UnitZ();
    contact.properties.thickness_m = kHeldThickness;
    return contact;
  };
  const auto velocities = [&](const std::vector<RepulsionContact>& contacts) {
    LaneVectors x, v;
    x.copy(V.topRows(2));
    v.resize(2);
    for (const Eigen::Index i : {0, 1}) {
      v.row(i) = Eigen::RowVector3d(0, 0, -0.5);
      x.row(i) += kHeldStep * v.row(i);
    }
    Swept held(contacts, {{{1, 0, 1.0}}, {}}, ground.surface(2), V, V, kHeldStep, 1);
    act(held, {kHeldStep, 1, x, v});
    EXPECT_EQ(held.count().repulsions, std::ssize(contacts));
    return std::pair{Eigen::RowVector3d(v.row(0)), Eigen::RowVector3d(v.row(1))};
  };
  const auto [first, second] = velocities({contact_of(0), contact_of(1)});
  EXPECT_EQ(second, velocities({contact_of(1)}).second);
  for (const Eigen::RowVector3d& v : {first, second}) EXPECT_LT(v.norm(), 1e-15);
}

TEST(SweptContacts, DoNotGoOnToAFaceThatHoldsTheVertex) {
  // The second face's last corner is the vertex itself.
  OneContact one = vertex_over_body(Vec3::Zero());
  const Ground ground(Faces{{1, 2, 3}, {2, 1, 0}}, {1, 0, 0, 0});
  const std::vector<RepulsionContact> contacts{one.contact};
  Swept held(contacts, {}, ground.surface(1), one.V_t0, one.V_t1, 2 * kHeldStep, 1);
  move_and_hold(one, held, {0, -2.1 / kHeldStep, 0}, 0.5);
  move_and_hold(one, held, {0, 0, -0.5}, 1);
  EXPECT_EQ(held.taken().front().second, 0);
}

TEST(SweptContacts, TakeTheSideOnWhichFarFeaturesAre) {
  // From above, as if the vertex had come from below. Ten thicknesses away it is free to leave; as near as that it has
  // passed through, and may not go farther.
  for (const double thicknesses : {10.0, 0.5}) {
    OneContact one = vertex_over_body(Vec3::Zero());
    one.x.row(0).z() = one.V_t0(0, 2) = thicknesses * kHeldThickness;
    one.contact.normal = -Vec3::UnitZ();
    const std::vector<RepulsionContact> contacts{one.contact};
    const Ground ground = one_face();
    Swept held(contacts, {}, ground.surface(1), one.V_t0, one.V_t1, kHeldStep, 1);
    move_and_hold(one, held, {0, 0, 1}, 1);
    EXPECT_EQ(one.v.row(0), Eigen::RowVector3d(0, 0, thicknesses > 1 ? 1 : 0));
    EXPECT_EQ(held.taken().front().normal, Vec3(0, 0, thicknesses > 1 ? 1 : -1));
  }
}

TEST(SweptContacts, EndWhereThePointsHaveSlidOffEachOther) {
  // Two steps: to the side, then down. The face ends at y = -2.
  for (const double to_y : {-1.9, -2.5}) {
    OneContact one = vertex_over_body(Vec3::Zero());
    const std::vector<RepulsionContact> contacts{one.contact};
    const Ground ground = one_face();
    Swept held(contacts, {}, ground.surface(1), one.V_t0, one.V_t1, 2 * kHeldStep, 1);
    move_and_hold(one, held, {0, to_y / kHeldStep, 0}, 0.5);
    move_and_hold(one, held, {0, 0, -0.5}, 1);
    EXPECT_EQ(held.count().repulsions, to_y > -2 ? 1 : 0);
    EXPECT_EQ(one.distance() < kHeldThickness, to_y < -2);
  }
}

}  // namespace selvage::sim::testbed
