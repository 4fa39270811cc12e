#include "sim/springs/stabilizer.h"

#include <gtest/gtest.h>

#include "sim/cloth.h"
#include "tests/sim/dynamics/plain_forces.h"
#include "tests/sim/random_cloth.h"

namespace selvage {

using namespace sim;

namespace {

double energy(const std::vector<Stabilizer>& stabilizers, const Positions& x) {
  double sum = 0;
  for (const Stabilizer& s : stabilizers) {
    sum += s.stiffness_n_m / 2 * bow_of(s, x).squaredNorm();
  }
  return sum;
}

/// Of stabilisers alone.
testing::LaneForces forces(const std::vector<Stabilizer>& stabilizers, const Positions& x, const Positions& v) {
  const auto count = static_cast<std::int32_t>(x.rows());
  const StabilizerSystem system(stabilizers, count);
  return testing::lane_forces(SpringSystem({}, count), &system, x, v);
}

void expect_stabilizers_balance(const Positions& x, const Positions& force) {
  Vec3 sum = Vec3::Zero(), torque = Vec3::Zero();
  for (Eigen::Index i = 0; i < x.rows(); ++i) {
    sum += force.row(i).transpose();
    torque += Vec3(x.row(i)).cross(Vec3(force.row(i)));
  }
  EXPECT_GT(force.norm(), 1);
  EXPECT_LE(sum.norm(), 1e-14 * double(x.rows()));
  EXPECT_LE(torque.norm(), 1e-14 * double(x.rows()));
}

}  // namespace

TEST(Stabilizer, PullsTheMiddleNodeBackBetweenItsNeighbours) {
  const std::vector<Stabilizer> one = {{{1, 0, 2, 0}, {1, -0.5, -0.5, 0}, 4, 0, 0}};
  Positions x(3, 3);
  x << -1, 0, 0, 0, 0, 0.1, 1, 0, 0;
  const Positions force = forces(one, x, x).elastic;
  EXPECT_NEAR(force(1, 2), -0.4, 1e-15);
  EXPECT_NEAR(force(0, 2), 0.2, 1e-15);
  EXPECT_NEAR(force(2, 2), 0.2, 1e-15);
  EXPECT_NEAR(force.col(0).norm(), 0, 1e-15);
  // A pair of springs folded flat on itself has no direction; the stabiliser still pushes it open.
  x << 1, 0, 0, 0, 0, 0, 1, 0, 0;
  EXPECT_NEAR(forces(one, x, x).elastic(1, 0), 4, 1e-15);
}

TEST(Stabilizer, RowSumIsThatOfTheMagnitudesOfTheMatrix) {
  const StabilizerSystem one({{{1, 0, 2, 0}, {1, -0.5, -0.5, 0}, 4, 0, 0}}, 4);
  EXPECT_EQ(one.row_sum_n_m(1), 4 + 2 + 2);
  EXPECT_EQ(one.row_sum_n_m(0), 1 + 2 + 1);
  EXPECT_EQ(one.row_sum_n_m(3), 0);
}

TEST(Stabilizer, ForcesAreMinusTheGradientOfTheEnergyAndKeepMomenta) {
  const auto cloth = testing::random_cloth(11, 7);
  const std::vector<Stabilizer> stabilizers = testing::sheet_stabilizers(7, 2, 0);
  EXPECT_EQ(stabilizers.size(), 2U * 5 * 7);
  const Positions force = forces(stabilizers, cloth.x, cloth.v).elastic;
  for (const Eigen::Index i : {0, 8, 24, 30}) {
    Positions moved = cloth.x;
    moved(i, 1) += 1e-4;
    const double up = energy(stabilizers, moved);
    moved(i, 1) -= 2e-4;
    EXPECT_NEAR(force(i, 1), -(up - energy(stabilizers, moved)) / 2e-4, 1e-8) << "quadratic: exact but for rounding";
  }
  expect_stabilizers_balance(cloth.x, force);
}

TEST(Stabilizer, DampingTakesEnergyAndKeepsMomenta) {
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    const auto cloth = testing::random_cloth(seed);
    const std::vector<Stabilizer> stabilizers = testing::sheet_stabilizers(9, 2, 0.5);
    const Positions damping = forces(stabilizers, cloth.x, cloth.v).damping;
    EXPECT_LT((damping.array() * cloth.v.array()).sum(), 0);
    expect_stabilizers_balance(cloth.x, damping);
    Positions turning(cloth.x.rows(), 3);
    for (Eigen::Index i = 0; i < turning.rows(); ++i) {
      turning.row(i) = (Vec3(0.3, -2, 1).cross(Vec3(cloth.x.row(i))) + Vec3(1, 2, 3)).transpose();
    }
    EXPECT_LE(forces(stabilizers, cloth.x, turning).damping.norm(), 1e-13 * damping.norm()) << "what turns is not bent";
  }
}

// Of a bow of length b the part b^2 / (b^2 + straight^2); none where it is not known where it points.
TEST(Stabilizer, DampingFadesWhereTheBowIsNearlyStraight) {
  const auto drag = [](double bow_m, double straight_m) {
    const std::vector<Stabilizer> one = {{{1, 0, 2, 0}, {1, -0.5, -0.5, 0}, 4, 3, straight_m}};
    Positions x(3, 3), v = Positions::Zero(3, 3);
    x << -1, 0, 0, 0, 0, bow_m, 1, 0, 0;
    v(1, 2) = 1;
    return forces(one, x, v).damping(1, 2);
  };
  EXPECT_NEAR(drag(1e-3, 0), -3, 1e-15);
  EXPECT_NEAR(drag(1e-3, 1e-6), -3, 1e-5);
  EXPECT_NEAR(drag(1e-6, 1e-6), -1.5, 1e-15);
  EXPECT_NEAR(drag(1e-16, 1e-6), 0, 1e-15);
  EXPECT_EQ(drag(0, 0), 0);
}

TEST(Stabilizer, OfAMeshIsAtRestWhereTheFacesAreFlat) {
  ClothSpec spec;
  spec.surface = MeshSpec{};
  spec.stabilize_n_m = 1;
  Shape flat;
  flat.x.resize(4, 3);
  flat.x << 0, 0, 0, 1, 0.2, 0, 0.3, 0.9, 0, 0.6, -0.7, 0;  // the edge 0-1 with 2 and 3 to either side
  flat.triangles = {{0, 1, 2}, {1, 0, 3}};
  const std::vector<Stabilizer> made = make_stabilizers(spec, flat, {1, 1, 1, 1});
  ASSERT_EQ(made.size(), 1U);
  EXPECT_NEAR(energy(made, flat.x), 0, 1e-30);
  Positions folded = flat.x;
  folded(2, 2) = 0.3;
  EXPECT_GT(energy(made, folded), 1e-3);
  spec.stabilize_n_m = 0;
  EXPECT_TRUE(make_stabilizers(spec, flat, {1, 1, 1, 1}).empty()) << "what is not asked for is not built";
}

}  // namespace selvage
