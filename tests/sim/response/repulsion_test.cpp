#include "sim/response/repulsion.h"

#include <array>

#include "tests/property.h"
#include "tests/sim/mechanics.h"
#include "tests/sim/response/response_properties.h"

namespace selvage::sim::testbed {

TEST(Repulsion, TakesAwayTheApproachAndNothingElseWithoutASpring) {
  const CollisionOptions options;
  EXPECT_EQ(repulsion(0.5e-3, -2e-3, 1, options, 1e-2).total(), 2e-3);
  EXPECT_EQ(repulsion(0.5e-3, 0, 1, options, 1e-2).total(), 0);
  EXPECT_EQ(repulsion(0.5e-3, 2e-3, 1, options, 1e-2).total(), 0);
}

TEST(Repulsion, LetsPairsComeToTheThicknessAndNoNearer) {
  const CollisionOptions options;
  EXPECT_EQ(repulsion(-0.5e-3, -0.4e-3, 1, options, 1e-2).total(), 0);
  EXPECT_NEAR(repulsion(-0.5e-3, -0.7e-3, 1, options, 1e-2).total(), 0.2e-3, 1e-18);
  EXPECT_EQ(repulsion(0, -0.7e-3, 1, options, 1e-2).total(), 0.7e-3);
}

TEST(Repulsion, SpringGivesTheSmallerOfItsForceAndAFractionOfTheOverlap) {
  CollisionOptions options;
  options.repulsion_stiffness_n_m = 100;
  const double overlap = 0.6e-3, dt_s = 1e-3, inverse_mass_kg = 1;
  const double by_force = dt_s * dt_s * 100 * overlap * inverse_mass_kg;  // 6e-8 m
  EXPECT_NEAR(repulsion(overlap, 0, inverse_mass_kg, options, dt_s).spring, by_force, 1e-18);
  options.repulsion_stiffness_n_m = 1e9;
  EXPECT_NEAR(repulsion(overlap, 0, inverse_mass_kg, options, dt_s).spring, 0.1 * overlap, 1e-18);
  EXPECT_NEAR(repulsion(overlap, 0.02e-3, inverse_mass_kg, options, dt_s).spring, 0.04e-3, 1e-18);
  EXPECT_EQ(repulsion(overlap, 0.07e-3, inverse_mass_kg, options, dt_s).spring, 0);  // already leaves faster
  EXPECT_EQ(repulsion(-0.5e-3, 0, inverse_mass_kg, options, dt_s).spring, 0);        // no overlap
  options.repulsion_stiffness_n_m = 1e308;                                           // overflow ends at the limit
  EXPECT_NEAR(repulsion(overlap, 0, 1e308, options, dt_s).spring, 0.1 * overlap, 1e-18);
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_NEAR(repulsion(overlap, 0, infinity, options, 1e-300).spring, 0.1 * overlap, 1e-18);  // 0 * infinity too
}

TEST(Repulsion, NeverLeavesTheOverlapFasterThanItsFraction) {
  selvage::testing::check_property(300, 21, [] {
    CollisionOptions options;
    options.repulsion_stiffness_n_m = std::exp2(number_between(-10, 40));
    const double overlap = number_between(-1e-3, 1e-3), displacement = number_between(-1e-3, 1e-3);
    const Repulsion push = repulsion(overlap, displacement, std::exp2(number_between(-5, 5)), options, 1e-2);
    RC_ASSERT(push.inelastic >= 0 && push.spring >= 0);
    const double after = displacement + push.total();
    RC_ASSERT(after >= std::min(overlap, 0.0) - 1e-18);
    RC_ASSERT(after <= std::max({displacement, 0.1 * overlap, std::min(overlap, 0.0)}) + 1e-18);
  });
}

TEST(Repulsion, EndsTheApproachOfAnyContact) {
  selvage::testing::check_property(200, 22, prop_repulsion_ends_the_approach);
}

TEST(Repulsion, OfARestPairThatTurnsIsNone) {
  // A vertex above the middle of a face, all of which turn about the x axis; or the vertex comes down, or through.
  constexpr double kDistance = 0.25;
  const PairVectors x{Vec3(0, 0, kDistance), Vec3(-2, -2, 0), Vec3(2, -2, 0), Vec3(0, 4, 0)};
  RepulsionContact contact;
  contact.interaction =
      make_interaction(PairKind::kVf, {0, 1, 2, 3}, {1, 1.0 / 3, 1.0 / 3, 1.0 / 3}, std::array<double, 4>{1, 1, 1, 1});
  contact.x_t0 = x;
  contact.normal = Vec3::UnitZ();
  contact.distance = kDistance;
  contact.mobility = effective_mobility(contact.interaction);
  contact.properties.thickness_m = kDistance;
  const auto pushed = [&](const PairVectors& x_t1) {
    Positions displacement(4, 3);
    for (std::size_t i = 0; i < 4; ++i) displacement.row(static_cast<Eigen::Index>(i)) = x_t1[i] - x[i];
    FrictionLoad load;
    (void)repel_contact(contact, displacement, CollisionOptions{}, 1e-2, 0, load);
    return load.pressed;
  };
  PairVectors turned, down = x, through = x;
  for (std::size_t i = 0; i < 4; ++i) turned[i] = Eigen::AngleAxisd(0.3, Vec3::UnitX()) * x[i];
  down[0].z() = 0.2;
  through[0].z() = -0.3;
  for (const bool is_of_rest : {false, true}) {
    contact.properties.is_of_rest = is_of_rest;
    EXPECT_NEAR(pushed(turned), is_of_rest ? 0 : kDistance * (1 - std::cos(0.3)), 1e-15);
    EXPECT_NEAR(pushed(down), 0.05, 1e-15);
    EXPECT_NEAR(pushed(through), 0.55, 1e-15);
  }
}

TEST(Repulsion, KeepsTheLimitOfALeverInAllItsSweeps) {
  // The only free corner of a face, below which a vertex of a body rises and slides.
  constexpr double kThickness = 0.01, kRise = 4e-3, kSlide = 3e-3;
  for (const double lever : {16.0, 64.0, 1e6}) {
    SCOPED_TRACE(lever);
    const double weight = 1 / lever;
    Positions V(4, 3), V_t1(4, 3);
    V << 0, weight, 0, 0, 1, kThickness, -2, 0, kThickness, 2, 0, kThickness;
    V_t1 = V;
    V_t1.row(0) += Eigen::RowVector3d(kSlide, 0, kRise);
    RepulsionContact contact;
    contact.interaction = make_interaction(PairKind::kVf, {0, 1, 2, 3}, {1, weight, (1 - weight) / 2, (1 - weight) / 2},
                                           std::array<double, 4>{0, 1, 0, 0});
    contact.x_t0 = gather(contact.interaction, V);
    contact.normal = -Vec3::UnitZ();
    contact.distance = kThickness;
    contact.mobility = effective_mobility(contact.interaction);
    contact.properties = {kThickness, 1e-6, 0.5, 0.5};
    StepMotion motion;
    motion.start(V, V_t1, Precision::kFloat64);
    Contacts contacts;
    contacts.add(contact);
    contacts.repel(CollisionOptions{}, 1e-2, kRepulsionSweeps, motion);
    const double asked_of_it = kMaxLever * kMaxLever / lever;
    EXPECT_NEAR(motion.displacement()(1, 2), asked_of_it * kRise, 1e-9 * kRise);
    EXPECT_LE(motion.displacement().row(1).head<2>().norm(), 0.5 * asked_of_it * kRise * (1 + 1e-9));
  }
}

namespace {

/// Two vertices that overlap and rest; the spring's force is far below its limit.
struct Overlap {
  static constexpr double kOverlap = 1e-3, kStep = 1e-3;
  RepulsionContact contact;
  CollisionOptions options;
  explicit Overlap(double inverse_mass_kg) {
    options.repulsion_stiffness_n_m = 10;
    const std::array<double, 4> inverse_mass{inverse_mass_kg, inverse_mass_kg, inverse_mass_kg, inverse_mass_kg};
    contact.interaction = make_interaction(PairKind::kVf, {0, 1, 2, 3}, {1, 1, 0, 0}, inverse_mass);
    contact.x_t0 = {Vec3(0, 0, kOverlap), Vec3::Zero(), Vec3::UnitX(), Vec3::UnitY()};
    contact.normal = Vec3::UnitZ();
    contact.distance = kOverlap;
    contact.mobility = effective_mobility(contact.interaction);
    contact.properties.thickness_m = 2 * kOverlap;
  }
  [[nodiscard]] double by_spring_m() const {  // k d dt^2 (1/m + 1/m)
    return 10 * kOverlap * kStep * kStep * 2 * contact.interaction.inverse_mass_scale;
  }
};

}  // namespace

TEST(Repulsion, PushesLightClothFartherByTheSameSpring) {
  for (const double inverse_mass_kg : {0.25, 1.0, 4.0}) {
    const Overlap overlap(inverse_mass_kg);
    FrictionLoad load;
    (void)repel_contact(overlap.contact, Positions::Zero(4, 3), overlap.options, Overlap::kStep, 0, load);
    EXPECT_NEAR(load.pressed, overlap.by_spring_m(), 1e-15 * overlap.by_spring_m()) << inverse_mass_kg;
  }
}

TEST(Repulsion, SpringActsInTheFirstSweepAlone) {
  const Overlap overlap(1);
  Positions displacement = Positions::Zero(4, 3);
  displacement(0, 2) = -1e-4;  // by a neighbour, after the first sweep
  FrictionLoad load;
  (void)repel_contact(overlap.contact, displacement, overlap.options, Overlap::kStep, 1, load);
  EXPECT_EQ(load.pressed, 1e-4) << "what approaches is stopped";
}

TEST(Repulsion, SpringActsOnceThoughContactsAreSweptAgainWithOthers) {
  const Overlap overlap(1);
  Positions V(4, 3);
  for (Eigen::Index i = 0; i < 4; ++i) V.row(i) = overlap.contact.x_t0[static_cast<std::size_t>(i)];
  StepMotion motion;
  motion.start(V, V, Precision::kFloat64);
  Contacts contacts;
  contacts.add(overlap.contact);
  for (int call = 0; call < 3; ++call) {
    contacts.repel(overlap.options, Overlap::kStep, 2, motion);
    EXPECT_EQ(contacts.count().repulsions, 1);
    const double apart_m = motion.displacement()(0, 2) - motion.displacement()(1, 2);
    EXPECT_NEAR(apart_m, overlap.by_spring_m(), 1e-15 * overlap.by_spring_m());
  }
}

}  // namespace selvage::sim::testbed
