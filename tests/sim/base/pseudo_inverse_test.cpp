#include "sim/base/pseudo_inverse.h"

#include <array>
#include <cmath>

#include <Eigen/Geometry>

#include "tests/property.h"
#include "tests/sim/mechanics.h"

namespace selvage::sim::testbed {
namespace {

/// Of any orientation.
Eigen::Matrix3d with_eigenvalues(const Eigen::Vector3d& values) {
  const Eigen::Vector3d axis(number_between(-1, 1), number_between(-1, 1), number_between(0.1, 1));
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(number_between(-3, 3), axis.normalized()).toRotationMatrix();
  const Eigen::Matrix3d matrix = turn * values.asDiagonal() * turn.transpose();
  return (matrix + matrix.transpose()) / 2;
}

}  // namespace

// Both where cofactors give it and where eigenvalues do.
TEST(PseudoInverse, PropIsTheInverseWhereThereIsOne) {
  std::array<int, 2> tried{};
  selvage::testing::check_property(500, 41, [&] {
    const double scale = std::pow(10.0, number_between(-60, 60));
    const Eigen::Vector3d values(1, std::pow(10.0, number_between(-3, 0)), std::pow(10.0, number_between(-3, 0)));
    const Eigen::Matrix3d matrix = scale * with_eigenvalues(values);
    ++tried[values.prod() > 1e-3 * std::pow(values.sum(), 3) ? 1 : 0];
    const Eigen::Matrix3d inverse = pseudo_inverse(matrix);
    RC_ASSERT((matrix * inverse - Eigen::Matrix3d::Identity()).norm() <= 1e-14 / values.minCoeff());
    RC_ASSERT((inverse - inverse.transpose()).norm() <= 1e-12 * inverse.norm());
  });
  EXPECT_GT(tried[0], 100);
  EXPECT_GT(tried[1], 100);
}

TEST(PseudoInverse, PropDropsTheDirectionsThatAreMissing) {
  selvage::testing::check_property(200, 42, [] {
    const double scale = std::pow(10.0, number_between(-60, 60)), second = *rc::gen::element(0.0, 0.3);
    const Eigen::Vector3d values(1, second, *rc::gen::element(0.0, 1e-14));
    const Eigen::Matrix3d matrix = scale * with_eigenvalues(values);
    const Eigen::Matrix3d inverse = pseudo_inverse(matrix);
    RC_ASSERT((matrix * inverse * matrix - matrix).norm() <= 1e-11 * matrix.norm());
    RC_ASSERT(inverse.norm() <= 4 / scale);
  });
}

TEST(PseudoInverse, OfZeroIsZero) {
  EXPECT_EQ(pseudo_inverse(Eigen::Matrix3d::Zero()), Eigen::Matrix3d(Eigen::Matrix3d::Zero()));
}

}  // namespace selvage::sim::testbed
