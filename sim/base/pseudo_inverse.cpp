#include "sim/base/pseudo_inverse.h"

#include <Eigen/Eigenvalues>

namespace selvage::sim {

Eigen::Matrix3d pseudo_inverse(const Eigen::Matrix3d& matrix) {
  const double trace = matrix.trace();
  if (matrix.determinant() > kFullRank * (trace * trace * trace)) return matrix.inverse();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(matrix);
  const double least = kRankTolerance * eigen.eigenvalues().maxCoeff();
  Eigen::Matrix3d result = Eigen::Matrix3d::Zero();
  for (Eigen::Index i = 0; i < 3; ++i) {
    const double value = eigen.eigenvalues()[i];
    const Eigen::Vector3d axis = eigen.eigenvectors().col(i);
    if (value > least) result += (axis / value) * axis.transpose();
  }
  return result;
}

}  // namespace selvage::sim
