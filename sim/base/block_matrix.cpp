#include "sim/base/block_matrix.h"

#include <algorithm>

#include "sim/base/parallel.h"

namespace selvage::sim {
namespace {

void add_product(const SymmetricBlock& block, const double* x, double* sum) {
  sum[0] += block[0] * x[0] + block[1] * x[1] + block[2] * x[2];
  sum[1] += block[1] * x[0] + block[3] * x[1] + block[4] * x[2];
  sum[2] += block[2] * x[0] + block[4] * x[1] + block[5] * x[2];
}

// By cofactors. False for a block that is not positive definite, by Sylvester's criterion.
bool invert(const SymmetricBlock& m, SymmetricBlock& inverse) {
  const double xx = m[3] * m[5] - m[4] * m[4], xy = m[2] * m[4] - m[1] * m[5], xz = m[1] * m[4] - m[2] * m[3];
  const double determinant = m[0] * xx + m[1] * xy + m[2] * xz, scale = 1 / determinant;
  inverse = {scale * xx,
             scale * xy,
             scale * xz,
             scale * (m[0] * m[5] - m[2] * m[2]),
             scale * (m[1] * m[2] - m[0] * m[4]),
             scale * (m[0] * m[3] - m[1] * m[1])};
  return m[0] > 0 && m[0] * m[3] - m[1] * m[1] > 0 && determinant > 0;
}

}  // namespace

double dot(const Positions& a, const Positions& b) {
  double sum = 0;
  for (Eigen::Index i = 0; i < a.rows(); ++i) sum += a(i, 0) * b(i, 0) + a(i, 1) * b(i, 1) + a(i, 2) * b(i, 2);
  return sum;
}

BlockMatrix::BlockMatrix(const std::vector<std::vector<VertexId>>& neighbours) : diagonal_(neighbours.size()) {
  for (const std::vector<VertexId>& row : neighbours) {
    neighbour_.insert(neighbour_.end(), row.begin(), row.end());
    begin_.push_back(neighbour_.size());
  }
  off_diagonal_.resize(neighbour_.size());
}

void BlockMatrix::multiply(const Positions& x, Positions& result) const {
  result.resize(rows(), 3);
  parallel_each(rows(), [&](Eigen::Index i) {
    double sum[3] = {0, 0, 0};
    add_product(diagonal(i), x.data() + 3 * i, sum);
    for (std::size_t slot = begin(i); slot < begin(i + 1); ++slot) {
      add_product(off_diagonal_[slot], x.data() + 3 * neighbour_[slot], sum);
    }
    for (int k = 0; k < 3; ++k) result(i, k) = sum[k];
  });
}

ConjugateGradientsResult solve_by_conjugate_gradients(const BlockMatrix& A, const Coupling* coupling,
                                                      std::span<const std::uint8_t> is_free, const Positions& rhs,
                                                      double relative_residual, std::int32_t max_iterations,
                                                      Positions& x) {
  ConjugateGradientsResult result;
  std::vector<SymmetricBlock> preconditioner(static_cast<std::size_t>(A.rows()));
  std::vector<std::uint8_t> is_definite(preconditioner.size(), 1);
  Positions residual(A.rows(), 3), scaled(A.rows(), 3), direction, product;
  const auto precondition = [&](Eigen::Index i) {
    double sum[3] = {0, 0, 0};
    add_product(preconditioner[static_cast<std::size_t>(i)], residual.data() + 3 * i, sum);
    for (int k = 0; k < 3; ++k) scaled(i, k) = sum[k];
  };
  parallel_each(A.rows(), [&](Eigen::Index i) {
    const auto row = static_cast<std::size_t>(i);
    if (is_free[row] != 0) {
      SymmetricBlock diagonal = A.diagonal(i);
      if (coupling != nullptr) coupling->add_diagonal(i, diagonal);
      is_definite[row] = invert(diagonal, preconditioner[row]) ? 1 : 0;
      residual.row(i) = rhs.row(i);
    } else {
      preconditioner[row] = {};
      residual.row(i).setZero();
    }
    precondition(i);
  });
  x = Positions::Zero(A.rows(), 3);
  result.definite = std::find(is_definite.begin(), is_definite.end(), 0) == is_definite.end();
  if (!result.definite) return result;
  direction = scaled;
  double energy = dot(residual, scaled);
  const double enough = relative_residual * relative_residual * energy;
  // Written so that NaN ends the loop.
  while (result.iterations < max_iterations && energy > enough) {
    A.multiply(direction, product);
    if (coupling != nullptr) coupling->add_product(direction, product);
    // Rows that are not free have no direction, so what the product has there does not count.
    const double curvature = dot(direction, product);
    if (curvature <= 0) {
      result.definite = false;
      return result;
    }
    const double along = energy / curvature;
    parallel_each(A.rows(), [&](Eigen::Index i) {
      x.row(i) += along * direction.row(i);
      residual.row(i) -= along * product.row(i);
      precondition(i);
    });
    const double next = dot(residual, scaled);
    const double share = next / energy;
    parallel_each(A.rows(), [&](Eigen::Index i) { direction.row(i) = scaled.row(i) + share * direction.row(i); });
    energy = next;
    ++result.iterations;
  }
  result.converged = energy <= enough;
  return result;
}

}  // namespace selvage::sim
