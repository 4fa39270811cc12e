#include "sim/velocity.h"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "tests/sim/random_cloth.h"

namespace selvage {

using namespace sim;
using testing::random_cloth;

namespace {

// The matrix of solve_velocity written down element by element.
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

}  // namespace

TEST(Velocity, SolvesTheSystemThatItStates) {
  const auto cloth = random_cloth(1, 6);
  const double dt_s = 0.01, drag = 3;
  std::vector<double> coefficient;
  for (const Spring& spring : cloth.springs.springs()) coefficient.push_back(0.01 * spring.stiffness_n_m);
  Positions direction, v = Positions::Zero(cloth.x.rows(), 3);
  cloth.springs.directions(cloth.x, direction);
  const auto iterations =
      solve_velocity({cloth.springs, cloth.inverse_mass, drag, coefficient}, direction, cloth.v, dt_s, v);
  EXPECT_LT(iterations, 200);

  Eigen::VectorXd rhs(3 * cloth.x.rows());
  for (Eigen::Index i = 0; i < cloth.x.rows(); ++i) {
    rhs.segment<3>(3 * i) = cloth.v.row(i).transpose() / cloth.inverse_mass[static_cast<std::size_t>(i)];
  }
  const Eigen::VectorXd expected = dense_matrix(cloth, coefficient, 1 + dt_s * drag).ldlt().solve(rhs);
  for (Eigen::Index i = 0; i < cloth.x.rows(); ++i) {
    EXPECT_LE((v.row(i).transpose() - expected.segment<3>(3 * i)).norm(), 1e-8);
  }
}

TEST(Velocity, HeldVerticesKeepTheirVelocity) {
  auto cloth = random_cloth(2, 6);
  cloth.inverse_mass[7] = 0;
  std::vector<double> coefficient(cloth.springs.springs().size(), 1.0);
  Positions direction, v = cloth.v;
  cloth.springs.directions(cloth.x, direction);
  solve_velocity({cloth.springs, cloth.inverse_mass, 0, coefficient}, direction, cloth.v, 0.01, v);
  EXPECT_EQ(Vec3(v.row(7)), Vec3(cloth.v.row(7)));
  EXPECT_NE(Vec3(v.row(8)), Vec3(cloth.v.row(8)));
}

}  // namespace selvage
