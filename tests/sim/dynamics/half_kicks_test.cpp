#include "sim/dynamics/half_kicks.h"

#include <gtest/gtest.h>

#include "tests/sim/dynamics/plain_forces.h"
#include "tests/sim/random_cloth.h"
#include "tests/vector_units.h"

namespace selvage::sim::testbed {
namespace {

using Row = Eigen::RowVector3d;

/// A cloth with a vertex that is held, and any forces and impulses.
struct Kicked {
  selvage::testing::RandomCloth cloth =
      selvage::testing::random_cloth(1, 35);  // two blocks of a parallel loop, and no whole number of lanes
  Positions force = selvage::testing::random_cloth(2, 35).v, impulses = 1e-3 * selvage::testing::random_cloth(3, 35).v;
  HalfKick kick{0.02, {{1, 2, -9.81}, 40, 30}};

  Kicked() { cloth.inverse_mass[11] = 0; }
};

}  // namespace

TEST(HalfKicks, OfAllForcesIsWhatItStates) {
  const Kicked k;
  Positions reference;
  selvage::testing::on_every_vector_unit([&](const char* unit) {
    LaneVectors v = selvage::testing::to_lanes(k.cloth.v), x_t1;
    explicit_half_kick(k.kick, selvage::testing::to_lanes(k.cloth.inverse_mass), selvage::testing::to_lanes(k.force),
                       selvage::testing::to_lanes(k.impulses), selvage::testing::to_lanes(k.cloth.x), v, x_t1);
    for (Eigen::Index i = 0; i < v.rows(); ++i) {
      const double w = k.cloth.inverse_mass[static_cast<std::size_t>(i)];
      const Row before = k.cloth.v.row(i);
      const double drag_1_s = k.kick.fields.drag_1_s + k.kick.fields.quadratic_drag_1_m * before.norm();
      const double of_drag = k.kick.h / 2 * drag_1_s, share = 1 / (1 + of_drag * (2 * of_drag / (1 + 2 * of_drag)));
      const Row acceleration = k.kick.fields.gravity_m_s2.transpose() - drag_1_s * before + w * k.force.row(i);
      const Row after = before + share * (k.kick.h / 2 * acceleration - w * k.impulses.row(i));
      const Row expected = w > 0 ? after : before, found = v.row(i);
      EXPECT_LE((found - expected).norm(), 1e-13 * (before.norm() + (after - before).norm())) << unit << ", " << i;
      EXPECT_EQ(Row(x_t1.row(i)), Row(k.cloth.x.row(i) + k.kick.h * found)) << unit << ", " << i;
    }
    if (reference.size() == 0) reference = selvage::testing::from_lanes(v);
    EXPECT_EQ(selvage::testing::from_lanes(v), reference) << unit;
  });
}

TEST(HalfKicks, OfWhatDoesNotDependOnTheVelocityIsWhatItStates) {
  const Kicked k;
  selvage::testing::on_every_vector_unit([&](const char* unit) {
    LaneVectors kicked;
    elastic_half_kick(k.kick, selvage::testing::to_lanes(k.cloth.inverse_mass), selvage::testing::to_lanes(k.force),
                      selvage::testing::to_lanes(k.cloth.v), kicked);
    for (Eigen::Index i = 0; i < kicked.rows(); ++i) {
      const double w = k.cloth.inverse_mass[static_cast<std::size_t>(i)];
      const Row acceleration = k.kick.fields.gravity_m_s2.transpose() + w * k.force.row(i);
      const Row after = k.cloth.v.row(i) + k.kick.h / 2 * acceleration;
      EXPECT_EQ(Row(kicked.row(i)), w > 0 ? after : Row(k.cloth.v.row(i))) << unit << ", " << i;
    }
  });
}

}  // namespace selvage::sim::testbed
