#include "sim/record/run_totals.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace selvage::sim {

/// Two concentric tubes, of which the inner pokes through by 0.05 mm, were left at 9 times their length and flew apart.
TEST(RunTotals, ARepairThatLeavesClothTornIsAShortfall) {
  RunTotals totals;
  totals.repair.largest_strain = kTornStrain;
  EXPECT_EQ(totals.shortfalls(), "");
  totals.repair.largest_strain = 8;
  EXPECT_EQ(totals.shortfalls(), "--repair left cloth at 9 times its length");
  totals.waiting_bodies = 1;
  EXPECT_EQ(totals.shortfalls(), "--repair left cloth at 9 times its length, 1 times a body waited");
}

TEST(RunTotals, TheLargestStrainIsKeptWithItsTimeAndPlace) {
  RunTotals totals;
  StepResult step;
  for (const double strain : {0.25, 0.75, 0.5}) {
    step.end_s += 1;
    step.most_strained = {strain, {static_cast<VertexId>(100 * strain), 7}};
    totals.add(step);
  }
  EXPECT_EQ(totals.largest_strain, 0.75);
  EXPECT_EQ(totals.largest_strain_at_s, 2);
  EXPECT_EQ(totals.largest_strain_from, 75);
  EXPECT_EQ(totals.largest_strain_to, 7);
}

TEST(RunTotals, AResidualThatIsNoNumberIsNotHiddenByOthers) {
  RunTotals totals;
  StepResult step;
  for (const double residual_m : {2e-5, std::numeric_limits<double>::quiet_NaN(), 1e-5, 3e-5}) {
    step.dynamics.residual_m = residual_m;
    totals.add(step);
  }
  EXPECT_TRUE(std::isnan(totals.largest_residual_m)) << totals.largest_residual_m;
}

}  // namespace selvage::sim
