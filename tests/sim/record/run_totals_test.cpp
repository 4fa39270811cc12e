#include "sim/record/run_totals.h"

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

}  // namespace selvage::sim
