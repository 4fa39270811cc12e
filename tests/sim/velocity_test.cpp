#include "sim/velocity.h"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "sim/central_differences.h"
#include "sim/velocity_march.h"
#include "tests/sim/random_cloth.h"

namespace selvage {

using namespace sim;
using testing::random_cloth;

namespace {

// The matrix of VelocitySolver written down element by element.
Eigen::MatrixXd dense_matrix(const testing::RandomCloth& cloth, const std::vector<double>& coefficient, double shift) {
  const Eigen::Index size = 3 * cloth.x.rows();
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(size, size);
  for (Eigen::Index i = 0; i < cloth.x.rows(); ++i) {
    const double mass = 1 / cloth.inverse_mass[static_cast<std::size_t>(i)];
    A.block<3, 3>(3 * i, 3 * i) += shift * mass * Eigen::Matrix3d::Identity();
  }
  for (std::size_t s = 0; s < coefficient.size(); ++s) {
    const Spring& spring = cloth.springs.springs()[s];
    const Vec3 n = (cloth.x.row(spring.b) - cloth.x.row(spring.a)).transpose().normalized();
    const Eigen::Matrix3d block = coefficient[s] * n * n.transpose();
    A.block<3, 3>(3 * spring.a, 3 * spring.a) += block;
    A.block<3, 3>(3 * spring.b, 3 * spring.b) += block;
    A.block<3, 3>(3 * spring.a, 3 * spring.b) -= block;
    A.block<3, 3>(3 * spring.b, 3 * spring.a) -= block;
  }
  return A;
}

Positions directions(const testing::RandomCloth& cloth) {
  SpringStretch stretch;
  cloth.springs.stretch(cloth.x, stretch);
  return stretch.direction;
}

}  // namespace

TEST(Velocity, SolvesTheSystemThatItStates) {
  const auto cloth = random_cloth(1, 6);
  const double dt_s = 0.01, drag = 3;
  std::vector<double> coefficient;
  for (const Spring& spring : cloth.springs.springs()) coefficient.push_back(0.01 * spring.stiffness_n_m);
  Positions v = Positions::Zero(cloth.x.rows(), 3);
  const VelocitySystem system{cloth.springs, cloth.inverse_mass, drag, coefficient};
  VelocitySolver solver;
  EXPECT_LT(solver.solve(system, directions(cloth), cloth.v, dt_s, v), 200);

  Eigen::VectorXd rhs(3 * cloth.x.rows());
  for (Eigen::Index i = 0; i < cloth.x.rows(); ++i) {
    rhs.segment<3>(3 * i) = cloth.v.row(i).transpose() / cloth.inverse_mass[static_cast<std::size_t>(i)];
  }
  const Eigen::VectorXd expected = dense_matrix(cloth, coefficient, 1 + dt_s * drag).ldlt().solve(rhs);
  for (Eigen::Index i = 0; i < cloth.x.rows(); ++i) {
    // All the residual may lie in one of the lightest vertices, among 36 of about 1 m/s.
    EXPECT_LE((v.row(i).transpose() - expected.segment<3>(3 * i)).norm(), 100 * kVelocityResidual);
  }
}

TEST(Velocity, HeldVerticesKeepTheirVelocity) {
  auto cloth = random_cloth(2, 6);
  cloth.inverse_mass[7] = 0;
  std::vector<double> coefficient(cloth.springs.springs().size(), 1.0);
  Positions v = cloth.v;
  VelocitySolver().solve({cloth.springs, cloth.inverse_mass, 0, coefficient}, directions(cloth), cloth.v, 0.01, v);
  EXPECT_EQ(Vec3(v.row(7)), Vec3(cloth.v.row(7)));
  EXPECT_NE(Vec3(v.row(8)), Vec3(cloth.v.row(8)));
}

TEST(Velocity, KeepsMomentaToRoundingWhateverConjugateGradientsLeave) {
  const auto cloth = random_cloth(3, 12);
  const std::vector<double> coefficient(cloth.springs.springs().size(), 0.5);
  Positions v = cloth.v;
  VelocitySolver().solve({cloth.springs, cloth.inverse_mass, 0, coefficient}, directions(cloth), cloth.v, 0.01, v);
  EXPECT_GT((v - cloth.v).norm(), 0.1 * cloth.v.norm());
  EXPECT_LE((linear_momentum(cloth, v) - linear_momentum(cloth, cloth.v)).norm(), 1e-14);
  EXPECT_LE((angular_momentum(cloth, v) - angular_momentum(cloth, cloth.v)).norm(), 1e-14);
}

TEST(VelocityMarch, LinearDampingDecaysExponentiallyAtFirstOrder) {
  // a = -c v: exactly exp(-c t) v. Ten times the steps, a tenth of the error.
  const double c = 3, time_s = 0.7;
  double error[2];
  int n = 0;
  for (const std::int32_t refinement : {10, 100}) {
    Positions v = Positions::Ones(1, 3);
    const auto steps = march_velocity([&](const Positions& u, Positions& a) { a = -c * u; }, c, time_s, refinement, v);
    EXPECT_EQ(steps, 5 * refinement) << "steps of at most kMarchContraction / c";
    error[n++] = std::abs(v(0, 0) - std::exp(-c * time_s));
  }
  EXPECT_NEAR(error[0] / error[1], 10, 1);
  EXPECT_LT(error[1], 1e-3);
}

TEST(VelocityMarch, QuadraticDragFollowsItsClosedForm) {
  // a = -c |v| v: exactly v / (1 + c |v| t), which no linear solve gives.
  const double c = 2, speed = 3, time_s = 0.5;
  Positions v(1, 3);
  v << speed, 0, 0;
  march_velocity([&](const Positions& u, Positions& a) { a = (-c * u.row(0).norm()) * u; }, 2 * c * speed, time_s, 200,
                 v);
  EXPECT_NEAR(v(0, 0), speed / (1 + c * speed * time_s), 1e-3);
}

// Section 7.6 has two ways; they must agree where both apply, the more the shorter the step.
TEST(VelocityMarch, AgreesWithConjugateGradientsAsTheStepShrinks) {
  const auto cloth = random_cloth(5, 8);
  CentralDifferencesOptions options;
  options.strain = {.strain = 0, .strain_rate = 0};
  options.step_s = 0.5 * stable_step_s(cloth.springs, cloth.inverse_mass);
  CentralDifferencesOptions marching = options;
  marching.quadratic_drag_1_m = 1e-300;  // marches, and drags nothing
  double difference[2];
  int n = 0;
  for (const double dt_s : {1e-3, 1e-4}) {
    Motion solved{cloth.x, cloth.v}, marched = solved;
    CentralDifferences(cloth.springs, options).final_velocity(solved, cloth.inverse_mass, dt_s);
    CentralDifferences(cloth.springs, marching).final_velocity(marched, cloth.inverse_mass, dt_s);
    difference[n++] = (solved.v - marched.v).norm() / (solved.v - cloth.v).norm();
  }
  EXPECT_LT(difference[0], 0.1);
  EXPECT_LT(difference[1], 0.2 * difference[0]);
}

}  // namespace selvage
