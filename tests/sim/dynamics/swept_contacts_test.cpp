// What contacts that are swept over press, rub, bear and learn.
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "tests/property.h"
#include "tests/sim/dynamics/swept_contact_scenes.h"

namespace selvage::sim::testbed {
namespace {

/// Vertices one above the other over a face of a body, a thickness apart: each lies on the one below by a contact of
/// its own.
struct Column {
  static constexpr int kCount = 12;
  static constexpr double kGravity = 10, kShort = 4e-4;
  Positions V = Positions(kCount + 3, 3);
  Ground ground{faces(), inverse_mass()};
  std::vector<RepulsionContact> contacts;
  ContactLoads loads;
  Candidates repelled;
  LaneVectors x, v;
  double highest = 0, lowest = 1;  ///< of the distances of neighbours over the thickness, ever

  Column() {
    for (int i = 0; i < kCount; ++i) V.row(i) = Eigen::RowVector3d(0, 0, (i + 1) * kHeldThickness);
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
    std::vector<double> result(kCount + 3, 16.0);
    for (std::size_t i = kCount; i < kCount + 3; ++i) result[i] = 0;
    return result;
  }

  [[nodiscard]] HeldSurface surface() const {
    HeldSurface result = ground.surface(kCount);
    result.gravity_m_s2 *= kGravity;
    return result;
  }

  void add(const std::array<VertexId, 4>& vertices, const std::array<double, 4>& weights) {
    RepulsionContact contact;
    contact.first = vertices[0];
    contact.second = static_cast<std::int32_t>(contacts.size());
    contact.interaction = make_interaction(PairKind::kVf, vertices, weights, ground.inverse_mass);
    contact.x_t0 = gather(contact.interaction, V);
    contact.normal = Vec3::UnitZ();
    contact.properties.thickness_m = kHeldThickness;
    contacts.push_back(contact);
  }

  /// One step of the dynamics, but for gravity and contact.
  void advance() {
    for (int i = 0; i < kCount; ++i) x.row(i) += kShort * v.row(i);
  }

  /// A collision step of 40 steps of the dynamics.
  void step(int sweeps) {
    constexpr int kSteps = 40;
    Swept held(contacts, loads, surface(), V, V, kSteps * kShort, sweeps);
    for (int step = 1; step <= kSteps; ++step) {
      for (int i = 0; i < kCount; ++i) v.row(i).z() -= kShort * kGravity;
      advance();
      act(held, {kShort, double(step) / kSteps, x, v});
      for (int i = 0; i < kCount; ++i) {
        const double gap = (x.row(i).z() - (i > 0 ? double(x.row(i - 1).z()) : 0)) / kHeldThickness;
        highest = std::max(highest, gap);
        lowest = std::min(lowest, gap);
      }
    }
    loads = held.loads();
    repelled = held.repelled_pairs();
  }
};

}  // namespace

TEST(SweptContacts, ComeNoNearerThanTheThicknessAndAddNeitherMomentumNorEnergy) {
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
      RC_ASSERT((one.x.row(i) - one.V_t0.row(i) - kHeldStep * one.v.row(i)).norm() <= 1e-12);  // x follows v
    }
    RC_CLASSIFY(count.repulsions > 0);
    if (count.repulsions > 0) RC_ASSERT(one.distance() >= std::min(kHeldThickness, one.contact.distance) - 1e-12);
    RC_ASSERT(std::ssize(one.repelled.vf) + std::ssize(one.repelled.ee) == count.repulsions);
  });
}

TEST(SweptContacts, PropALoneContactTakesBackWhatItsLoadOrOverRelaxedSweepsWereTooMuch) {
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
    RC_ASSERT(with.borne().size() == without.borne().size());
    if (!without.borne().empty()) {
      const double learnt_m_s2 = without.borne()[0].acceleration_m_s2 + load_m_s2 / 2;
      RC_ASSERT(std::abs(with.borne()[0].acceleration_m_s2 - learnt_m_s2) <= 1e-10);
      const Vec3 learnt = friction_of(without.borne()[0]) + friction_m_s2 / 2;
      RC_ASSERT((friction_of(with.borne()[0]) - learnt).norm() <= 1e-9);
    }
  });
}

/// Whose first edge comes nearer, but for the vertex that cannot move, if any.
RandomPair edges_that_meet(std::size_t still) {
  RandomPair pair = random_contact(kHeldThickness);
  while (contact_of(pair, kHeldThickness).kind != PairKind::kEe) pair = random_contact(kHeldThickness);
  pair.displacement = {-Vec3::UnitZ(), -Vec3::UnitZ(), Vec3::Zero(), Vec3::Zero()};
  if (still < 4) {
    pair.inverse_mass[still] = 0;
    pair.displacement[still] = Vec3::Zero();
  }
  pair.interaction = make_interaction(PairKind::kEe, {0, 1, 2, 3}, pair.interaction.weights, pair.inverse_mass);
  return pair;
}

TEST(SweptContacts, OfEdgesRememberNothingWhereAVertexCannotMove) {
  selvage::testing::check_property(200, 34, [] {
    const int still = integer_in(0, 8);  // beyond 3: none
    const RandomPair pair = edges_that_meet(static_cast<std::size_t>(still));
    RC_PRE(lever_share(pair.interaction) == 1);
    OneContact one(pair, 4);
    RC_PRE(one.step().repulsions > 0);
    RC_CLASSIFY(still < 4);
    RC_ASSERT(one.loads.vf.empty());
    RC_ASSERT(one.loads.ee.empty() == (still < 4));
  });
}

TEST(SweptContacts, LearnHalfOfWhatTheyHadToAddByPair) {
  OneContact one = vertex_over_body({0.2, 0.3, -1});
  one.contact.first = 3;
  one.contact.second = 7;
  one.step();
  ASSERT_EQ(one.loads.vf.size(), 1U);
  EXPECT_EQ(one.loads.vf[0].first, 3);
  EXPECT_EQ(one.loads.vf[0].second, 7);
  EXPECT_NEAR(one.loads.vf[0].acceleration_m_s2, 0.5 / kHeldStep,
              1e-12);  // half of the 1 m/s that it took away in a step
  EXPECT_LT((friction_of(one.loads.vf[0]) - Vec3(-0.1, -0.15, 0) / kHeldStep).norm(), 1e-12);  // and of the slip
  OneContact leaves = vertex_over_body({0, 0, 1});
  leaves.step(5);
  EXPECT_TRUE(leaves.loads.empty());
}

TEST(SweptContacts, LearnNothingThatLeavesTheRangeOfDoubles) {
  for (const double begun_m_s2 : {0.0, 1.7e308}) {  // the slip asks for the opposite
    OneContact one = vertex_over_body({2e307, 0, -5e307});
    one.step(begun_m_s2, 1, Vec3(begun_m_s2, 0, 0));
    ASSERT_EQ(one.loads.vf.size(), 1U);
    EXPECT_TRUE(std::isfinite(one.loads.vf[0].acceleration_m_s2));
    EXPECT_TRUE(friction_of(one.loads.vf[0]).allFinite());
  }
  OneContact too_fast = vertex_over_body({2.4e307, 0, -5e307});
  too_fast.step();
  ASSERT_EQ(too_fast.loads.vf.size(), 1U);
  EXPECT_EQ(friction_of(too_fast.loads.vf[0]), Vec3(0, 0, 0));
}

TEST(SweptContacts, AColumnRestsOnItsLoads) {
  // Where two sweeps begin at the other end in every other step, it swings.
  for (const int sweeps : {1, 2, 3, 4}) {
    SCOPED_TRACE(sweeps);
    Column column;
    for (int collision_step = 0; collision_step < 75; ++collision_step) column.step(sweeps);
    EXPECT_GT(column.lowest, 0.99);
    EXPECT_LT(column.highest, 1.01);
    for (int i = 0; i < Column::kCount; ++i) EXPECT_LT(column.v.row(i).norm(), 1e-6) << i;
    ASSERT_EQ(column.loads.vf.size(), static_cast<std::size_t>(Column::kCount));
    EXPECT_NEAR(column.loads.vf[0].acceleration_m_s2, Column::kCount * Column::kGravity, 1e-3)
        << "the lowest bears all";
  }
}

/// What a limit on strain would do to two that move along z.
void share(Column& column, const std::array<int, 2>& vertices) {
  const double mean = (column.v.row(vertices[0]).z() + column.v.row(vertices[1]).z()) / 2;
  for (const int i : vertices) {
    column.x.row(i).z() += Column::kShort * (mean - column.v.row(i).z());
    column.v.row(i).z() = mean;
  }
}

/// How often the limits are asked in each of some steps of the first vertex of a column alone, on a body that rises,
/// which bore 400 m/s a step and shares what it has with the last vertex, that meets nothing. Both have their
/// velocities then.
std::vector<int> limits_in_steps(int steps, Column& column, double rises_m_s) {
  const double dt_s = steps * Column::kShort;
  Positions V_t1 = column.V;
  V_t1.bottomRows(3).col(2).array() += dt_s * rises_m_s;
  column.contacts.resize(1);
  column.loads.vf = {{0, 0, 400 / Column::kShort}};
  Swept held(column.contacts, column.loads, column.surface(), column.V, V_t1, dt_s, 1);
  std::vector<int> counts;
  for (int step = 1; step <= steps; ++step) {
    column.advance();
    counts.push_back(0);
    held.hold({Column::kShort, double(step) / steps, column.x, column.v}, [&] {
      ++counts.back();
      share(column, {0, Column::kCount - 1});
    });
  }
  return counts;
}

TEST(SweptContacts, ActAgainWithoutLoadsWhereTheyAddEnergy) {
  // At rest there would be 200 m/s up and 200 down, of nothing.
  for (const double rises_m_s : {0.0, 50.0}) {
    Column column;
    EXPECT_EQ(limits_in_steps(1, column, rises_m_s), std::vector{2}) << rises_m_s;
    EXPECT_NEAR(column.v.row(0).z(), rises_m_s, 1e-9);
    EXPECT_NEAR(column.x.row(0).z(), kHeldThickness + Column::kShort * rises_m_s, 1e-12);
    EXPECT_EQ(column.v.row(Column::kCount - 1).z(), 0);
  }
}

TEST(SweptContacts, BeginEachStepWithLoads) {
  // Half of what was no use in the first one.
  Column column;
  EXPECT_EQ(limits_in_steps(2, column, 50), std::vector({2, 2}));
  EXPECT_NEAR(column.v.row(0).z(), 50, 1e-9);
}

TEST(SweptContacts, ActAgainInTheSameDirection) {
  // Of a column that falls, the other way round other vertices would be held.
  Column with, without;
  with.loads.vf = {{0, 0, 400 / Column::kShort}};
  for (Column* column : {&with, &without}) {
    for (int i = 0; i < Column::kCount; ++i) column->v.row(i).z() = -Column::kShort * Column::kGravity;
    column->advance();
    Swept held(column->contacts, column->loads, column->surface(), column->V, column->V, Column::kShort, 1);
    int count = 0;
    held.hold({Column::kShort, 1, column->x, column->v}, [&] {
      ++count;
      share(*column, {0, Column::kCount - 1});
    });
    EXPECT_EQ(count, column == &with ? 2 : 1);
  }
  for (int i = 0; i < Column::kCount; ++i) EXPECT_EQ(with.v.row(i).z(), without.v.row(i).z()) << i;
}

TEST(SweptContacts, ActAgainWithTheLoadsOfOtherCloth) {
  // The last vertex is of no face and beside the first, which gains what it shares with the one below the last.
  constexpr int kOther = Column::kCount - 1, kSharing = kOther - 1;
  Column column;
  column.V.row(kOther) << 0.5, 0, kHeldThickness;
  column.contacts.resize(1);
  column.add({kOther, Column::kCount, Column::kCount + 1, Column::kCount + 2}, {1, 5.0 / 24, 11.0 / 24, 1.0 / 3});
  column.loads.vf = {{0, 0, 400 / Column::kShort}, {kOther, 1, Column::kGravity}};
  column.v.row(kOther).z() = -Column::kShort * Column::kGravity;
  column.x.row(kOther) = column.V.row(kOther) + Column::kShort * column.v.row(kOther);
  Swept held(column.contacts, column.loads, column.surface(), column.V, column.V, Column::kShort, 1);
  int count = 0;
  held.hold({Column::kShort, 1, column.x, column.v}, [&] {
    EXPECT_NEAR(column.v.row(kOther).z(), 0, 1e-12) << "it is borne, time " << count;
    ++count;
    share(column, {0, kSharing});
  });
  EXPECT_EQ(count, 2);
  EXPECT_NEAR(column.v.row(0).z(), 0, 1e-9);
}

TEST(SweptContacts, ActAgainWhereTheyAddMoreThanAFallOf100StepsOfTheDynamics) {
  // The load v of the first vertex pushes it, half of which the second gets; then it gets the velocity r of the body,
  // which does the work of both impulses. Left is 3/8 m v^2 - m v r / 2 - m r^2 / 2.
  Positions V(5, 3);
  V << 0, 0, kHeldThickness, 5, 0, 0, -2, -2, 0, 2, -2, 0, 0, 4, 0;
  const Ground ground(Faces{{2, 3, 4}}, {3, 3, 0, 0, 0});
  RepulsionContact contact;
  contact.interaction =
      make_interaction(PairKind::kVf, {0, 2, 3, 4}, {1, 1.0 / 3, 1.0 / 3, 1.0 / 3}, ground.inverse_mass);
  contact.normal = Vec3::UnitZ();
  contact.properties.thickness_m = kHeldThickness;
  const double fall_m_s = 100 * kHeldStep;
  for (const auto& [steps, rises_m_s] : {std::pair{1, 0.0}, {2, 0.0}, {1, 6.0}}) {
    SCOPED_TRACE(::testing::Message() << steps << " steps, rises by " << rises_m_s);
    const double squares = rises_m_s * rises_m_s + fall_m_s * fall_m_s;
    const double most_m_s = (rises_m_s / 2 + std::sqrt(rises_m_s * rises_m_s / 4 + 0.75 * squares)) / 0.75;
    Positions V_t1 = V;
    V_t1.bottomRows(3).col(2).array() += steps * kHeldStep * rises_m_s;
    for (const double share_of_most : {0.99, 1.01}) {
      LaneVectors x, v;
      x.copy(V.topRows(2));
      v.resize(2);
      v.set_zero();
      Swept held({contact}, {{{0, 0, share_of_most * most_m_s / kHeldStep}}, {}}, ground.surface(2), V, V_t1,
                 steps * kHeldStep, 1);
      for (int step = 1; step <= steps; ++step) {
        for (const Eigen::Index i : {0, 1}) x.row(i) += kHeldStep * v.row(i);
        int count = 0;
        held.hold({kHeldStep, double(step) / steps, x, v}, [&] {
          ++count;
          const double mean = (v.row(0).z() + v.row(1).z()) / 2;
          for (const Eigen::Index i : {0, 1}) {
            x.row(i).z() += kHeldStep * (mean - v.row(i).z());
            v.row(i).z() = mean;
          }
        });
        EXPECT_EQ(count, step == 1 && share_of_most > 1 ? 2 : 1) << "step " << step << ", " << share_of_most;
      }
    }
  }
}

TEST(SweptContacts, KeepLoadsWhereTheEnergyIsWhatABodyBrings) {
  Column column;
  EXPECT_EQ(limits_in_steps(1, column, 400), std::vector{1});
  EXPECT_NEAR(column.v.row(0).z(), 400, 1e-9);
  EXPECT_NEAR(column.v.row(Column::kCount - 1).z(), 200, 1e-9);
}

TEST(SweptContacts, KeepLoadsWhereTheEnergyIsWhatTheLimitsBring) {
  // As those at pins do, that pull.
  Column column;
  column.contacts.resize(1);
  column.loads.vf = {{0, 0, Column::kGravity}};
  column.v.row(0).z() = -Column::kShort * Column::kGravity;
  column.x.row(0).z() += Column::kShort * column.v.row(0).z();
  Swept held(column.contacts, column.loads, column.surface(), column.V, column.V, Column::kShort, 1);
  int count = 0;
  held.hold({Column::kShort, 1, column.x, column.v}, [&] {
    ++count;
    EXPECT_NEAR(column.v.row(0).z(), 0, 1e-12) << "it is borne";
    column.v.row(0).x() = 100;
    column.x.row(0).x() = Column::kShort * 100;
  });
  EXPECT_EQ(count, 1);
  EXPECT_EQ(column.v.row(0).x(), 100);
}

TEST(SweptContacts, KeepTheLimitOfALever) {
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
    V << 0, 1, kHeldThickness, 0, 1 / kLever, 0, -2, 0, kHeldThickness, 2, 0, kHeldThickness;
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
    contact.properties.thickness_m = kHeldThickness;
    LaneVectors x, v;
    x.copy(V.topRows(1));
    v.resize(1);
    v.set_zero();
    const Ground ground(Faces{{2, 3, 0}}, {1, 0, 0, 0});
    Swept held({contact}, {{{0, 0, load_m_s2}}, {}}, ground.surface(1), V, V_t1, kHeldStep, sweeps);
    act(held, {kHeldStep, 1, x, v});
    const double moved = x.row(0).z() - V(0, 2);
    EXPECT_NEAR(moved, kMaxLever * kMaxLever / kLever * kRise, 1e-3 * kRise) << sweeps;
    EXPECT_TRUE(held.loads().empty());
    EXPECT_EQ(held.repelled_pairs(), (Candidates{{{0, 0}}, {}})) << "it pressed, though it remembers nothing";
  }
}

TEST(SweptContacts, NameThePairsThatRepelledOnceEachAndSorted) {
  Column column;
  std::ranges::reverse(column.contacts);
  column.contacts.push_back(column.contacts.front());  // a pair that collided while it was held is held twice
  column.step(1);
  Candidates all;
  for (int i = 0; i < Column::kCount; ++i) all.vf.push_back({i, i});
  EXPECT_EQ(column.repelled, all);
}

}  // namespace selvage::sim::testbed
