#include "sim/stabilizer.h"

#include <gtest/gtest.h>

#include "sim/cloth.h"
#include "tests/sim/random_cloth.h"

namespace selvage {

using namespace sim;

namespace {

ClothSpec sheet_spec() {
  ClothSpec spec;
  spec.surface = SheetSpec{7, 5, 1, 1};
  spec.stabilize_n_m = 2;
  spec.damping_ratio = 0.3;
  return spec;
}

double energy(const std::vector<Stabilizer>& stabilizers, const Positions& x) {
  double sum = 0;
  for (const Stabilizer& s : stabilizers) {
    Vec3 vector = Vec3::Zero();
    for (std::size_t i = 0; i < 4; ++i) {
      if (s.weights[i] != 0) vector += s.weights[i] * x.row(s.vertices[i]).transpose();
    }
    sum += s.stiffness_n_m / 2 * vector.squaredNorm();
  }
  return sum;
}

}  // namespace

TEST(Stabilizer, PullsTheMiddleNodeBackBetweenItsNeighbours) {
  const std::vector<Stabilizer> one = {{{1, 0, 2, 0}, {1, -0.5, -0.5, 0}, 4, 0}};
  const StabilizerSystem system(one, 3);
  Positions x(3, 3), force = Positions::Zero(3, 3);
  x << -1, 0, 0, 0, 0, 0.1, 1, 0, 0;
  system.add_forces(x, 1, 0, force);
  EXPECT_NEAR(force(1, 2), -0.4, 1e-15);
  EXPECT_NEAR(force(0, 2), 0.2, 1e-15);
  EXPECT_NEAR(force(2, 2), 0.2, 1e-15);
  EXPECT_NEAR(force.col(0).norm(), 0, 1e-15);
  // A pair of springs folded flat on itself has no direction; the stabiliser still pushes it open.
  x << 1, 0, 0, 0, 0, 0, 1, 0, 0;
  force.setZero();
  system.add_forces(x, 1, 0, force);
  EXPECT_NEAR(force(1, 0), 4, 1e-15);
}

TEST(Stabilizer, ForcesAreMinusTheGradientOfTheEnergyAndKeepMomenta) {
  const auto cloth = testing::random_cloth(11, 7);
  ClothSpec spec = sheet_spec();
  spec.surface = SheetSpec{7, 7, 1, 1};
  const Shape rest = make_sheet(7, 7, 1, 1);
  const std::vector<double> mass(49, 1e-3);
  const std::vector<Stabilizer> stabilizers = make_stabilizers(spec, rest, mass);
  EXPECT_EQ(stabilizers.size(), 2U * 5 * 7);
  const StabilizerSystem system(stabilizers, 49);
  Positions force = Positions::Zero(49, 3);
  system.add_forces(cloth.x, 1, 0, force);
  EXPECT_GT(force.norm(), 1);
  for (const Eigen::Index i : {0, 8, 24, 30}) {
    Positions moved = cloth.x;
    moved(i, 1) += 1e-4;
    const double up = energy(stabilizers, moved);
    moved(i, 1) -= 2e-4;
    EXPECT_NEAR(force(i, 1), -(up - energy(stabilizers, moved)) / 2e-4, 1e-8) << "quadratic: exact but for rounding";
  }
  Vec3 sum = Vec3::Zero(), torque = Vec3::Zero();
  for (Eigen::Index i = 0; i < 49; ++i) {
    sum += force.row(i).transpose();
    torque += Vec3(cloth.x.row(i)).cross(Vec3(force.row(i)));
  }
  EXPECT_LE(sum.norm(), 1e-14 * 49);
  EXPECT_LE(torque.norm(), 1e-14 * 49);
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
