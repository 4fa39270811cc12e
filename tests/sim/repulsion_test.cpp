#include "sim/repulsion.h"

#include "tests/property.h"
#include "tests/sim/mechanics.h"
#include "tests/sim/response_properties.h"

namespace selvage::sim::testing {

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

}  // namespace selvage::sim::testing
