#include "sim/held_contacts.h"

#include <cmath>

#include "tests/property.h"
#include "tests/sim/mechanics.h"

namespace selvage::sim::testing {
namespace {

constexpr double kThickness = 0.25, kStep = 0.125;

/// What contacts are on: `faces` over all vertices, of which those with mass come first.
struct Ground {
  Mesh mesh;
  VertexFaces faces;
  ContactTable properties;
  std::vector<double> inverse_mass;

  Ground(const Faces& F, std::vector<double> inverse_masses)
      : mesh(make_mesh(static_cast<std::int32_t>(inverse_masses.size()), F)),
        faces(mesh),
        properties(mesh, options(), {}),
        inverse_mass(std::move(inverse_masses)) {}
  static CollisionOptions options() {
    CollisionOptions options;
    options.thickness_m = kThickness;
    return options;
  }
  [[nodiscard]] HeldSurface surface(Eigen::Index cloth_count) const {
    return {mesh, faces, properties, inverse_mass, cloth_count, -Vec3::UnitZ()};
  }
};

void act(HeldContacts& held, const MidstepMotion& step) {
  held.bear(step);
  held.hold(step);
}

/// The face of the contact alone.
Ground one_face() { return {Faces{{1, 2, 3}}, std::vector<double>(4, 0.0)}; }

/// Four vertices of one contact, along z at the start.
struct OneContact {
  RepulsionContact contact;
  Positions V_t0, V_t1;
  Eigen::Index cloth_count;
  LaneVectors x, v;
  std::vector<ContactLoad> loads;

  OneContact(const RandomPair& pair, Eigen::Index cloth_vertices) : V_t0(4, 3), cloth_count(cloth_vertices) {
    for (Eigen::Index i = 0; i < 4; ++i) V_t0.row(i) = pair.x_t0[static_cast<std::size_t>(i)];
    V_t1 = V_t0;
    contact = contact_of(pair, kThickness);
    x.copy(V_t0.topRows(cloth_count));
    v.resize(cloth_count);
    for (Eigen::Index i = 0; i < cloth_count; ++i) v.row(i) = pair.displacement[static_cast<std::size_t>(i)];
  }

  /// One step of a collision step of one, which begins with a load. Leaves the load that it ends with.
  RepulsionCount step(double load_m_s2 = 0, int sweeps = 1, const Vec3& friction_m_s2 = Vec3::Zero()) {
    for (Eigen::Index i = 0; i < cloth_count; ++i) x.row(i) += kStep * v.row(i);
    const std::vector<RepulsionContact> contacts{contact};
    const Ground ground = one_face();
    const ContactLoad load{
        contact.first, contact.second, load_m_s2, {friction_m_s2.x(), friction_m_s2.y(), friction_m_s2.z()}};
    HeldContacts held(contacts, {load}, ground.surface(cloth_count), V_t0, V_t1, kStep, sweeps);
    act(held, {kStep, 1, x, v});
    loads = held.loads();
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

Vec3 friction_of(const ContactLoad& load) { return Vec3(load.friction_m_s2.data()); }

/// One step of the dynamics in which the first vertex moves at v, m/s.
void move_and_hold(OneContact& one, HeldContacts& held, const Eigen::RowVector3d& v, double share) {
  one.v.row(0) = v;
  one.x.row(0) += kStep * v;
  act(held, {kStep, share, one.x, one.v});
}

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

/// Vertices one above the other over a face of a body, a thickness apart: each lies on the one below by a contact of
/// its own.
struct Column {
  static constexpr int kCount = 12;
  static constexpr double kGravity = 10, kShort = 4e-4;
  Positions V = Positions(kCount + 3, 3);
  Ground ground{faces(), inverse_mass()};
  std::vector<RepulsionContact> contacts;
  std::vector<ContactLoad> loads;
  LaneVectors x, v;
  double highest = 0, lowest = 1;  ///< of the distances of neighbours over the thickness, ever

  Column() {
    for (int i = 0; i < kCount; ++i) V.row(i) = Eigen::RowVector3d(0, 0, (i + 1) * kThickness);
    V.bottomRows(3) << -2, -2, 0, 2, -2, 0, 0, 4, 0;
    add({0, kCount, kCount + 1, kCount + 2}, {1, 1.0 / 3, 1.0 / 3, 1.0 / 3});
    // The nearest point of the next one's face is its corner below: the others have no weight.
    for (int i = 1; i < kCount; ++i) add({i, i - 1, kCount + 1, kCount + 2}, {1, 1, 0, 0});
    x.copy(V.topRows(kCount));
    v.resize(kCount);
    v.set_zero();
  }

  static Faces faces() {
    Faces F(kCount, 3);
    for (int i = 0; i < kCount; ++i) F.row(i) = Eigen::RowVector3i(i == 0 ? kCount : i - 1, kCount + 1, kCount + 2);
    return F;
  }
  static std::vector<double> inverse_mass() {
    std::vector<double> result(kCount + 3, 1.0);
    for (std::size_t i = kCount; i < kCount + 3; ++i) result[i] = 0;
    return result;
  }

  void add(const std::array<VertexId, 4>& vertices, const std::array<double, 4>& weights) {
    RepulsionContact contact;
    contact.first = vertices[0];
    contact.second = static_cast<std::int32_t>(contacts.size());
    contact.interaction = make_interaction(PairKind::kVf, vertices, weights, ground.inverse_mass);
    contact.x_t0 = gather(contact.interaction, V);
    contact.normal = Vec3::UnitZ();
    contact.properties.thickness_m = kThickness;
    contacts.push_back(contact);
  }

  /// A collision step of 40 steps of the dynamics.
  void step(int sweeps) {
    constexpr int kSteps = 40;
    HeldContacts held(contacts, loads, ground.surface(kCount), V, V, kSteps * kShort, sweeps);
    for (int step = 1; step <= kSteps; ++step) {
      for (int i = 0; i < kCount; ++i) {
        v.row(i).z() -= kShort * kGravity;
        x.row(i) += kShort * v.row(i);
      }
      act(held, {kShort, double(step) / kSteps, x, v});
      for (int i = 0; i < kCount; ++i) {
        const double gap = (x.row(i).z() - (i > 0 ? double(x.row(i - 1).z()) : 0)) / kThickness;
        highest = std::max(highest, gap);
        lowest = std::min(lowest, gap);
      }
    }
    loads = held.loads();
  }
};

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

TEST(HeldContacts, PropALoneContactTakesBackWhatItsLoadOrOverRelaxedSweepsWereTooMuch) {
  selvage::testing::check_property(300, 33, [] {
    const RandomPair pair = random_contact(number_between(1e-3, 0.4));
    RC_PRE(lever_share(pair.interaction) == 1);
    OneContact without(pair, 4);
    without.contact.properties.friction_static = without.contact.properties.friction_kinetic = number_between(0, 1);
    OneContact with = without;
    without.step();
    const double load_m_s2 = number_between(0, 100);
    const Vec3 friction_m_s2(number_between(-50, 50), number_between(-50, 50), number_between(-50, 50));
    with.step(load_m_s2, integer_in(1, 5), friction_m_s2);
    RC_CLASSIFY(!without.loads.empty());
    for (Eigen::Index i = 0; i < 4; ++i) {
      RC_ASSERT((with.v.row(i) - without.v.row(i)).norm() <= 1e-11);
      RC_ASSERT((with.x.row(i) - without.x.row(i)).norm() <= 1e-11);
    }
    RC_ASSERT(with.loads.empty() == without.loads.empty());
    if (without.contact.kind == PairKind::kEe) RC_ASSERT(with.loads.empty());
    if (!without.loads.empty()) {
      const double learnt_m_s2 = without.loads[0].acceleration_m_s2 + load_m_s2 / 2;
      RC_ASSERT(std::abs(with.loads.at(0).acceleration_m_s2 - learnt_m_s2) <= 1e-10);
      const Vec3 learnt = friction_of(without.loads[0]) + friction_m_s2 / 2;
      RC_ASSERT((friction_of(with.loads[0]) - learnt).norm() <= 1e-9);
    }
  });
}

TEST(HeldContacts, LearnHalfOfWhatTheyHadToAddByPair) {
  OneContact one = vertex_over_body({0.2, 0.3, -1});
  one.contact.first = 3;
  one.contact.second = 7;
  one.step();
  ASSERT_EQ(one.loads.size(), 1U);
  EXPECT_EQ(one.loads[0].vertex, 3);
  EXPECT_EQ(one.loads[0].face, 7);
  EXPECT_NEAR(one.loads[0].acceleration_m_s2, 0.5 / kStep, 1e-12);  // half of the 1 m/s that it took away in a step
  EXPECT_LT((friction_of(one.loads[0]) - Vec3(-0.1, -0.15, 0) / kStep).norm(), 1e-12);  // and of the slip
  OneContact leaves = vertex_over_body({0, 0, 1});
  leaves.step(5);
  EXPECT_TRUE(leaves.loads.empty());
}

TEST(HeldContacts, LearnNothingThatLeavesTheRangeOfDoubles) {
  for (const double begun_m_s2 : {0.0, 1.7e308}) {  // the slip asks for the opposite
    OneContact one = vertex_over_body({2e307, 0, -5e307});
    one.step(begun_m_s2, 1, Vec3(begun_m_s2, 0, 0));
    ASSERT_EQ(one.loads.size(), 1U);
    EXPECT_TRUE(std::isfinite(one.loads[0].acceleration_m_s2));
    EXPECT_TRUE(friction_of(one.loads[0]).allFinite());
  }
  OneContact too_fast = vertex_over_body({2.4e307, 0, -5e307});
  too_fast.step();
  ASSERT_EQ(too_fast.loads.size(), 1U);
  EXPECT_EQ(friction_of(too_fast.loads[0]), Vec3(0, 0, 0));
}

TEST(HeldContacts, AColumnRestsOnItsLoads) {
  // Where two sweeps begin at the other end in every other step, it swings.
  for (const int sweeps : {1, 2, 3, 4}) {
    SCOPED_TRACE(sweeps);
    Column column;
    for (int collision_step = 0; collision_step < 75; ++collision_step) column.step(sweeps);
    EXPECT_GT(column.lowest, 0.99);
    EXPECT_LT(column.highest, 1.01);
    for (int i = 0; i < Column::kCount; ++i) EXPECT_LT(column.v.row(i).norm(), 1e-6) << i;
    ASSERT_EQ(column.loads.size(), static_cast<std::size_t>(Column::kCount));
    EXPECT_NEAR(column.loads[0].acceleration_m_s2, Column::kCount * Column::kGravity, 1e-3) << "the lowest bears all";
  }
}

TEST(HeldContacts, KeepTheLimitOfALever) {
  // The only free corner of a face, 32 times as far from the body's vertex below it as the corners that are held. The
  // vertex rises.
  constexpr double kLever = 32, kRise = 1e-3;
  struct Case {
    int sweeps;
    bool is_found_late;
    double load_m_s2;
  };
  for (const auto& [sweeps, is_found_late, load_m_s2] :
       {Case{1, false, 0}, {4, false, 0}, {1, true, 0}, {4, true, 0}, {1, false, 1e-3}, {4, false, 1e-3}}) {
    SCOPED_TRACE(::testing::Message() << sweeps << " sweeps, the lever is " << (is_found_late ? "found" : "known")
                                      << ", it bore " << load_m_s2);
    Positions V(4, 3), V_t1(4, 3);
    V << 0, 1, kThickness, 0, 1 / kLever, 0, -2, 0, kThickness, 2, 0, kThickness;
    V_t1 = V;
    V_t1(1, 2) += kRise;
    RepulsionContact contact;
    contact.interaction =
        make_interaction(PairKind::kVf, {1, 2, 3, 0}, {1, (1 - 1 / kLever) / 2, (1 - 1 / kLever) / 2, 1 / kLever},
                         std::array<double, 4>{1, 0, 0, 0});
    ASSERT_LT(lever_share(contact.interaction), 0.5);
    if (is_found_late) contact.interaction.weights = {1, -1.0 / 3, -1.0 / 3, -1.0 / 3};
    contact.x_t0 = gather(contact.interaction, V);
    contact.normal = -Vec3::UnitZ();
    contact.properties.thickness_m = kThickness;
    LaneVectors x, v;
    x.copy(V.topRows(1));
    v.resize(1);
    v.set_zero();
    const Ground ground(Faces{{2, 3, 0}}, {1, 0, 0, 0});
    HeldContacts held({contact}, {{0, 0, load_m_s2}}, ground.surface(1), V, V_t1, kStep, sweeps);
    act(held, {kStep, 1, x, v});
    const double moved = x.row(0).z() - V(0, 2);
    EXPECT_NEAR(moved, kMaxLever * kRise, 1e-3 * kRise) << sweeps;
    EXPECT_TRUE(held.loads().empty());
  }
}

TEST(HeldContacts, DoNotActWhereThePointsAreOnVerticesThatCannotMove) {
  // The body's vertex has come to be over a held corner of the face; the contact was that of the middle.
  Positions V(4, 3);
  V << 0, 2, 0, -2, 0, 0, 2, 0, 0, 2, 0, kThickness / 2;
  RepulsionContact contact;
  contact.interaction =
      make_interaction(PairKind::kVf, {3, 0, 1, 2}, {1, 1.0 / 3, 1.0 / 3, 1.0 / 3}, std::array<double, 4>{1, 0, 0, 0});
  contact.x_t0 = gather(contact.interaction, V);
  contact.normal = Vec3::UnitZ();
  contact.properties.thickness_m = kThickness;
  const Ground ground(Faces{{0, 1, 2}}, {1, 0, 0, 0});
  for (const double load_m_s2 : {0.0, 5.0}) {
    LaneVectors x, v;
    x.copy(V.topRows(3));
    v.resize(3);
    v.set_zero();
    v.row(0) = Eigen::RowVector3d(0, 0, 1);
    x.row(0) += kStep * v.row(0);
    HeldContacts held({contact}, {{0, 0, load_m_s2}}, ground.surface(3), V, V, kStep, 1);
    act(held, {kStep, 1, x, v});
    EXPECT_EQ(Eigen::RowVector3d(v.row(0)), Eigen::RowVector3d(0, 0, 1));
    EXPECT_EQ(held.count().repulsions, 0);
  }
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
  const Ground ground = one_face();
  HeldContacts held(contacts, {}, ground.surface(1), one.V_t0, one.V_t1, 2 * kStep, 1);
  EXPECT_EQ(held.contacts().front().normal, one.contact.normal);
  one.x.row(0) += kStep * one.v.row(0);
  act(held, {kStep, 0.5, one.x, one.v});
  one.v.row(0) = Eigen::RowVector3d(0, 0, -1);
  one.x.row(0) += kStep * one.v.row(0);
  act(held, {kStep, 1, one.x, one.v});
  const RepulsionContact now = held.contacts().front();
  EXPECT_LT((now.normal - Vec3(0, -0.1, kThickness).normalized()).norm(), 1e-12);
  EXPECT_NEAR(now.distance, (Vec3(0, 0, kThickness) - Vec3(0, -2, 0)).dot(now.normal), 1e-12);
  const Vec3 moved = one.x.row(0) - one.V_t0.row(0);
  EXPECT_GE(now.distance + moved.dot(now.normal), kThickness - 1e-12);
}

/// A vertex, and a flat body of two faces that meet at y = -2: the first as in vertex_over_body().
struct TwoFaces {
  Positions V = Positions(5, 3);
  OneContact one = vertex_over_body(Vec3::Zero());
  Ground ground{Faces{{1, 2, 3}, {2, 1, 4}}, {1, 0, 0, 0, 0}};

  TwoFaces() {
    V.topRows(4) = one.V_t0;
    V.row(4) << 0, -6, 0;
  }
};

TEST(HeldContacts, GoOnToTheFaceOnWhichAVertexSlides) {
  // Over the border, then down.
  for (const double to_x : {0.0, 1.5, -2.5}) {
    SCOPED_TRACE(to_x);
    TwoFaces scene;
    OneContact& one = scene.one;
    const std::vector<RepulsionContact> contacts{one.contact};
    HeldContacts held(contacts, {}, scene.ground.surface(1), scene.V, scene.V, 3 * kStep, 1);
    move_and_hold(one, held, {to_x / kStep, -2.5 / kStep, 0}, 1.0 / 3);
    for (const double share : {2.0 / 3, 1.0}) move_and_hold(one, held, {0, 0, -0.5}, share);
    if (to_x == -2.5) {  // beside both faces: 0.6 m to the border, nothing holds it
      EXPECT_EQ(held.count().repulsions, 0);
      continue;
    }
    EXPECT_EQ(held.count().repulsions, 1);
    EXPECT_NEAR(one.x.row(0).z(), kThickness, 1e-15);
    const RepulsionContact now = held.contacts().front();
    EXPECT_EQ(now.second, 1);
    EXPECT_EQ(now.second_t0, 0) << "the pair that was met";
    EXPECT_EQ(now.interaction.vertices, (std::array<VertexId, 4>{0, 2, 1, 4}));
    EXPECT_NEAR(now.distance, kThickness, 1e-15);
    ASSERT_EQ(held.loads().size(), 1U);
    EXPECT_EQ(held.loads()[0].face, 1);
  }
}

TEST(HeldContacts, WhatHasPassedThroughBesideTheBorderIsHeldAsItWas) {
  // Below the second face: nearer than the thickness to it, and nearer or farther than that to the border of the first.
  for (const double y : {-2.1, -2.35, -2.6}) {
    SCOPED_TRACE(y);
    TwoFaces scene;
    OneContact& one = scene.one;
    scene.V.row(0) = Eigen::RowVector3d(0, y, -0.1);
    one.x.row(0) = scene.V.row(0);
    const std::vector<RepulsionContact> contacts{one.contact};
    HeldContacts held(contacts, {}, scene.ground.surface(1), scene.V, scene.V, kStep, 1);
    move_and_hold(one, held, {0, 0, -1}, 1);
    EXPECT_EQ(one.v.row(0), Eigen::RowVector3d(0, 0, 0));
    EXPECT_EQ(held.contacts().front().normal, Vec3::UnitZ());
  }
}

TEST(HeldContacts, DoNotGoOnToAFaceThatCannotMove) {
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
  contact.properties.thickness_m = kThickness;
  LaneVectors x, v;
  x.copy(V.topRows(4));
  v.resize(4);
  v.set_zero();
  constexpr int kSteps = 6;
  HeldContacts held({contact}, {}, ground.surface(4), V, V_t1, kSteps * kStep, 1);
  for (int step = 1; step <= kSteps; ++step) {
    for (Eigen::Index i = 0; i < 4; ++i) x.row(i) += kStep * v.row(i);
    act(held, {kStep, double(step) / kSteps, x, v});
    for (Eigen::Index i = 1; i < 4; ++i) EXPECT_EQ(x.row(i), V.row(i)) << step;
    EXPECT_TRUE(x.row(0).allFinite()) << step;
    EXPECT_GT(held.contacts().front().mobility, 0) << step;
  }
}

TEST(HeldContacts, OneThatSlidesOnToAVertexOfAnotherActsAfterIt) {
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
    contact.properties.thickness_m = kThickness;
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
      x.row(i) += kStep * v.row(i);
    }
    std::int64_t repulsions = 0;
    for (const std::vector<RepulsionContact>& contacts : one_after_the_other) {
      HeldContacts held(contacts, {}, ground.surface(8), V, V, 2 * kStep, 1);
      act(held, {kStep, 1, x, v});
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

TEST(HeldContacts, BearWhatTheVertexBoreOnAFaceBeside) {
  // Over the border of two faces a vertex lies on either.
  constexpr double kLoad = 7;
  TwoFaces scene;
  const auto learnt = [&](const std::vector<ContactLoad>& loads) {
    HeldContacts held({scene.one.contact}, loads, scene.ground.surface(1), scene.V, scene.V, kStep, 1);
    const std::vector<ContactLoad> begun = held.loads();
    return begun.empty() ? 0 : begun.front().acceleration_m_s2;
  };
  EXPECT_EQ(learnt({{0, 0, kLoad}}), kLoad);
  EXPECT_EQ(learnt({{0, 1, kLoad}}), kLoad);
  EXPECT_EQ(learnt({{0, 0, kLoad}, {0, 1, 3}}), kLoad) << "its own first";
  EXPECT_EQ(learnt({{1, 0, kLoad}}), 0) << "another vertex";
  EXPECT_EQ(learnt({}), 0);
}

TEST(HeldContacts, DoNotGoOnToAFaceThatHoldsTheVertex) {
  // The second face's last corner is the vertex itself.
  OneContact one = vertex_over_body(Vec3::Zero());
  const Ground ground(Faces{{1, 2, 3}, {2, 1, 0}}, {1, 0, 0, 0});
  const std::vector<RepulsionContact> contacts{one.contact};
  HeldContacts held(contacts, {}, ground.surface(1), one.V_t0, one.V_t1, 2 * kStep, 1);
  move_and_hold(one, held, {0, -2.1 / kStep, 0}, 0.5);
  move_and_hold(one, held, {0, 0, -0.5}, 1);
  EXPECT_EQ(held.contacts().front().second, 0);
}

TEST(HeldContacts, TakeTheSideOnWhichFarFeaturesAre) {
  // From above, as if the vertex had come from below. Ten thicknesses away it is free to leave; as near as that it has
  // passed through, and may not go farther.
  for (const double thicknesses : {10.0, 0.5}) {
    OneContact one = vertex_over_body(Vec3::Zero());
    one.x.row(0).z() = one.V_t0(0, 2) = thicknesses * kThickness;
    one.contact.normal = -Vec3::UnitZ();
    const std::vector<RepulsionContact> contacts{one.contact};
    const Ground ground = one_face();
    HeldContacts held(contacts, {}, ground.surface(1), one.V_t0, one.V_t1, kStep, 1);
    move_and_hold(one, held, {0, 0, 1}, 1);
    EXPECT_EQ(one.v.row(0), Eigen::RowVector3d(0, 0, thicknesses > 1 ? 1 : 0));
    EXPECT_EQ(held.contacts().front().normal, Vec3(0, 0, thicknesses > 1 ? 1 : -1));
  }
}

TEST(HeldContacts, EndWhereThePointsHaveSlidOffEachOther) {
  // Two steps: to the side, then down. The face ends at y = -2.
  for (const double to_y : {-1.9, -2.5}) {
    OneContact one = vertex_over_body(Vec3::Zero());
    const std::vector<RepulsionContact> contacts{one.contact};
    const Ground ground = one_face();
    HeldContacts held(contacts, {}, ground.surface(1), one.V_t0, one.V_t1, 2 * kStep, 1);
    move_and_hold(one, held, {0, to_y / kStep, 0}, 0.5);
    move_and_hold(one, held, {0, 0, -0.5}, 1);
    EXPECT_EQ(held.count().repulsions, to_y > -2 ? 1 : 0);
    EXPECT_EQ(one.distance() < kThickness, to_y < -2);
  }
}

}  // namespace selvage::sim::testing
