#include "sim/spring.h"

#include <cmath>
#include <limits>

#include <Eigen/Geometry>
#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include "sim/rigid_path.h"
#include "sim/velocity.h"
#include "tests/sim/random_cloth.h"

namespace selvage {

using namespace sim;
using testing::random_cloth;

namespace {

constexpr double kRounding = 1e-12;  // relative to the sum of magnitudes: about 500 terms of 2^-53 each, generously

SpringSystem one_spring(double stiffness, double damping) {
  return {{Spring{0, 1, SpringKind::kStructural, 1.0, stiffness, damping}}, 2};
}

Positions damping_force(const testing::RandomCloth& cloth, const Positions& v) {
  SpringStretch stretch;
  std::vector<double> coefficient;
  for (const Spring& spring : cloth.springs.springs()) coefficient.push_back(spring.damping_n_s_m);
  cloth.springs.stretch(cloth.x, stretch);
  Positions product;
  damping_impulses({cloth.springs, cloth.inverse_mass, 0, coefficient}, stretch.direction, v, product);
  return -product;
}

Positions elastic_forces(const SpringSystem& springs, const Positions& x) {
  SpringStretch stretch;
  springs.stretch(x, stretch);
  Positions force;
  springs.elastic_forces(stretch, force);
  return force;
}

void expect_no_net_force_or_torque(const Positions& x, const Positions& force) {
  Vec3 sum = Vec3::Zero(), torque = Vec3::Zero();
  double magnitude = 0;
  for (Eigen::Index i = 0; i < x.rows(); ++i) {
    const Vec3 arm = x.row(i), pull = force.row(i);
    sum += pull;
    torque += arm.cross(pull);
    magnitude += pull.norm();
  }
  EXPECT_GT(magnitude, 0);
  EXPECT_LE(sum.norm(), kRounding * magnitude);
  EXPECT_LE(torque.norm(), kRounding * magnitude);
}

}  // namespace

TEST(Spring, PullsByHookesLaw) {
  Positions x(2, 3), expected(2, 3);
  x << 0, 0, 0, 1.5, 0, 0;
  expected << 4, 0, 0, -4, 0, 0;  // 8 N/m times 0.5 m
  EXPECT_LE((elastic_forces(one_spring(8, 0), x) - expected).norm(), 1e-15);
}

TEST(Spring, OfLengthZeroPullsNowhere) {
  for (const double length : {0.0, std::numeric_limits<double>::denorm_min()}) {
    Positions x = Positions::Zero(2, 3);
    x(1, 1) = length;
    EXPECT_EQ(elastic_forces(one_spring(8, 1), x), Positions::Zero(2, 3)) << length;
  }
}

TEST(Spring, InternalForcesKeepMomenta) {
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    const auto cloth = random_cloth(seed);
    expect_no_net_force_or_torque(cloth.x, elastic_forces(cloth.springs, cloth.x));
    expect_no_net_force_or_torque(cloth.x, damping_force(cloth, cloth.v));
  }
}

TEST(Spring, ForcesTurnWithTheCloth) {
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    const auto cloth = random_cloth(seed);
    const Eigen::Matrix3d R = rotation_matrix(Vec3(30.0 + seed, -70, 110));
    const Positions turned = (cloth.x * R.transpose()).rowwise() + Eigen::RowVector3d(0.5, -0.25, 1);
    const Positions force = elastic_forces(cloth.springs, cloth.x);
    const Positions force_turned = elastic_forces(cloth.springs, turned);
    EXPECT_LE((force_turned - force * R.transpose()).norm(), 1e-11 * force.norm());
  }
}

TEST(Spring, DampingIsZeroForRigidMotionAndTakesEnergyOtherwise) {
  const auto cloth = random_cloth(3);
  Positions rigid(cloth.x.rows(), 3);
  for (Eigen::Index i = 0; i < rigid.rows(); ++i) {
    const Vec3 arm = cloth.x.row(i);
    rigid.row(i) = (Vec3(0.3, -2, 1).cross(arm) + Vec3(1, 2, 3)).transpose();
  }
  EXPECT_LE(damping_force(cloth, rigid).norm(), kRounding * damping_force(cloth, cloth.v).norm());
  EXPECT_LT((damping_force(cloth, cloth.v).array() * cloth.v.array()).sum(), 0);
}

TEST(Spring, StableStepIsTheOscillatorsLimitAtMost) {
  // Two masses m on a spring k: omega^2 = 2 k / m.
  const double m = 0.002, k = 80;
  const std::vector<double> inverse_mass = {1 / m, 1 / m};
  EXPECT_NEAR(stable_step_s(one_spring(k, 0), inverse_mass), 2 / std::sqrt(2 * k / m), 1e-15);
}

TEST(Spring, ForcesAreTheSameBitsForAnyThreadCount) {
  const auto cloth = random_cloth(5, 70);
  Positions reference;
  for (const std::size_t threads : {1u, 2u, 4u}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    const Positions force = elastic_forces(cloth.springs, cloth.x);
    if (threads == 1) reference = force;
    EXPECT_EQ(force, reference) << threads << " threads";
  }
}

}  // namespace selvage
