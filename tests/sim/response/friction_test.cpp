#include "sim/response/friction.h"

#include "tests/property.h"
#include "tests/sim/mechanics.h"
#include "tests/sim/response/response_properties.h"

namespace selvage::sim::testbed {
namespace {

using selvage::testing::check_property;

constexpr double kGap = 0.5e-3;

/// A cloth vertex kGap above a scripted floor triangle, moving with `displacement`.
struct VertexOnFloor {
  std::array<double, 4> inverse_mass{2, 0, 0, 0};
  Interaction interaction = make_interaction(PairKind::kVf, {0, 1, 2, 3}, {1, 0.5, 0.25, 0.25}, inverse_mass);
  PairVectors x_t0{Vec3(0, 0, kGap), Vec3(-1, -1, 0), Vec3(1, -1, 0), Vec3(1, 3, 0)};
};

/// The first friction of a contact that has pressed by `pressed`.
std::optional<PairVectors> first_friction(const Interaction& interaction, const PairVectors& x_t0,
                                          const PairVectors& displacement, double pressed,
                                          const FrictionCoefficients& friction) {
  FrictionLoad load{pressed};
  return friction_change(interaction, x_t0, displacement, Vec3::UnitZ(), friction, load);
}

double slip(const PairVectors& displacement) { return displacement[0].head<2>().norm(); }

}  // namespace

TEST(Friction, SlidingVertexSlowsByMuTimesTheNormalChange) {
  const VertexOnFloor scene;
  const PairVectors displacement{Vec3(3, 4, -1), Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
  const auto change = first_friction(scene.interaction, scene.x_t0, displacement, 1, {0.5, 0.3});
  ASSERT_TRUE(change);
  const PairVectors after = sum(displacement, *change);
  EXPECT_NEAR(slip(after), 5 - 0.3, 1e-14);
  EXPECT_NEAR(after[0].x() / after[0].y(), 3.0 / 4.0, 1e-14);
  EXPECT_EQ(after[0].z(), -1);
  for (std::size_t i = 1; i < 4; ++i) EXPECT_EQ((*change)[i], Vec3(0, 0, 0));
}

TEST(Friction, SticksBelowTheStaticLimitAndSlidesAboveIt) {
  const VertexOnFloor scene;
  const auto slip_after = [&](double slip_before, double on_static, double on_kinetic, double creep_m = 0) {
    const PairVectors displacement{Vec3(slip_before, 0, -1), Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
    const auto change =
        first_friction(scene.interaction, scene.x_t0, displacement, 1, {on_static, on_kinetic, creep_m});
    return change ? slip(sum(displacement, *change)) : slip_before;
  };
  EXPECT_NEAR(slip_after(0.49, 0.5, 0.3), 0, 1e-15);           // below mu_s: sticks
  EXPECT_NEAR(slip_after(0.51, 0.5, 0.3), 0.51 - 0.3, 1e-15);  // above: slides with mu_k
  EXPECT_NEAR(slip_after(0.2, 0.3, 0.3), 0, 1e-15);
  EXPECT_NEAR(slip_after(0.4, 0.3, 0.3), 0.1, 1e-15);
  EXPECT_EQ(slip_after(0.4, 0, 0), 0.4);
  EXPECT_EQ(slip_after(0.4, 0.3, 0), 0.4);                   // slides, and sliding costs nothing
  EXPECT_NEAR(slip_after(0.7, 0.5, 0.3, 0.41), 0.2, 1e-15);  // creeps: 0.4 would be left with mu_k
  EXPECT_NEAR(slip_after(0.7, 0.5, 0.3, 0.39), 0.4, 1e-15);
  EXPECT_NEAR(slip_after(0.49, 0.5, 0.3, 0.41), 0, 1e-15);
}

TEST(Friction, AllFrictionsOfAStepShareOneCone) {
  const VertexOnFloor scene;
  FrictionLoad load{1};
  const auto slip_after = [&](const Vec3& motion) {
    const PairVectors displacement{motion, Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
    const auto change = friction_change(scene.interaction, scene.x_t0, displacement, Vec3::UnitZ(), {0.5, 0.3}, load);
    return change ? slip(sum(displacement, *change)) : slip(displacement);
  };
  EXPECT_NEAR(slip_after(Vec3(0.2, 0, 0)), 0, 1e-15);
  EXPECT_NEAR(slip_after(Vec3(0.25, 0, 0)), 0, 1e-15) << "sticks: 0.45 in all";
  EXPECT_EQ(slip_after(Vec3(0.1, 0, 0)), 0.1) << "the static limit is passed, and the kinetic one was before";
  EXPECT_NEAR(slip_after(Vec3(-0.25, 0, 0)), 0, 1e-15) << "against the others: 0.2 is left of them";
  EXPECT_NEAR(slip_after(Vec3(0, 0.6, 0)), 0.6 - std::sqrt(0.3 * 0.3 - 0.2 * 0.2), 1e-15) << "to the kinetic limit";
  load.pressed = 2;
  EXPECT_NEAR(slip_after(Vec3(0, 0.5, 0)), 0, 1e-15) << "a wider cone";
}

TEST(Friction, IsThePapersFormulaWhereThePointsMeet) {
  // As the separation goes to 0 the torque does too: dv_T = mu dv_N, shared by weights and masses.
  check_property(100, 31, [] {
    const RandomPair pair = random_contact(1e-13);
    Vec3 slip_before = relative(pair.interaction, pair.displacement);
    slip_before.z() = 0;
    RC_PRE(slip_before.norm() > 0.1 && lever_share(pair.interaction) == 1);
    const auto change = first_friction(pair.interaction, pair.x_t0, pair.displacement, 0.25, {0.2, 0.2});
    RC_ASSERT(change.has_value());
    const PairVectors paper = distribute(pair.interaction, -0.05 * slip_before.normalized());
    for (std::size_t i = 0; i < 4; ++i) RC_ASSERT(((*change)[i] - paper[i]).norm() <= 1e-9);
  });
}

TEST(Friction, KeepsBothMomentaAddsNoEnergyAndStaysInTheCone) {
  check_property(500, 32, prop_friction_keeps_momenta_and_the_cone);
}

TEST(Friction, AddsNoEnergyWhereMassesDifferByMoreThanDoublesHold) {
  int rubbed = 0;
  check_property(2000, 35, [&] {
    const RandomPair pair = contact_of_extreme_masses();
    const double friction = std::pow(10, number_between(0, 12));
    const auto change = first_friction(pair.interaction, pair.x_t0, pair.displacement, 1, {friction, friction});
    if (!change) return;
    ++rubbed;
    const auto& mobility = pair.interaction.mobility;
    const auto heaviest = static_cast<std::size_t>(std::ranges::min_element(mobility) - mobility.begin());
    double before = 0, after = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      const Vec3 d = pair.displacement[i] - pair.displacement[heaviest];
      before += d.squaredNorm() / pair.interaction.mobility[i];
      after += (d + (*change)[i]).squaredNorm() / pair.interaction.mobility[i];
    }
    RC_ASSERT(after <= before * (1 + 1e-9));
  });
  EXPECT_GT(rubbed, 1000);
}

TEST(Friction, DoesNotBrakeARigidRotation) {
  check_property(100, 33, [] {
    RandomPair pair = random_contact(0.1);
    const Vec3 omega = vector_within(1);
    for (std::size_t i = 0; i < 4; ++i) pair.displacement[i] = omega.cross(pair.x_t0[i]);
    const auto change = first_friction(pair.interaction, pair.x_t0, pair.displacement, 1, {1, 1});
    if (change) {
      for (const Vec3& c : *change) RC_ASSERT(c.norm() <= 1e-9);
    }
  });
}

TEST(Friction, StaysFiniteForHugeAndTinyMotions) {
  check_property(100, 34, [] {
    RandomPair pair = random_contact(1e-3);
    const double scale = std::exp2(number_between(-1000, 1000));
    for (Vec3& d : pair.displacement) d *= scale;
    const auto change = first_friction(pair.interaction, pair.x_t0, pair.displacement, scale, {0.5, 0.5});
    if (change) {
      for (const Vec3& c : *change) RC_ASSERT(c.allFinite());
    }
  });
}

}  // namespace selvage::sim::testbed
