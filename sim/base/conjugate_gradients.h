// Conjugate gradients on a block matrix, and on what is coupled to it.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sim/base/block_matrix.h"
#include "sim/base/lane_vectors.h"

namespace selvage::sim {

/// What a matrix has beside its blocks; symmetric.
class Coupling {
 public:
  virtual ~Coupling() = default;
  /// result += (this) x.
  virtual void add_product(const LaneVectors& x, LaneVectors& result) const = 0;
  /// block += the diagonal block at row i of this.
  virtual void add_diagonal(Eigen::Index i, SymmetricBlock& block) const = 0;
};

struct ConjugateGradientsResult {
  std::int32_t iterations = 0;
  bool converged = false;  ///< false after max_iterations, or where a number is not finite
  bool definite = true;    ///< false where A was found not to be positive definite on the free rows: x is of no use
};

/// Eight rows at once, in parallel, in a fixed order: same bits for any thread count and vector unit, where the
/// coupling has them. Keeps its memory.
class ConjugateGradients {
 public:
  /// Solves A x = rhs on the rows with is_free; the others of x become zero, and A acts as if their rows and columns
  /// were not there. The preconditioner is the inverse of the diagonal blocks; ends when the residual is
  /// `relative_residual` of rhs in its norm. `coupling`, where it is not null, is a part of A.
  ConjugateGradientsResult solve(const BlockMatrix& A, const Coupling* coupling, std::span<const std::uint8_t> is_free,
                                 const Positions& rhs, double relative_residual, std::int32_t max_iterations,
                                 Positions& x);

 private:
  [[nodiscard]] bool invert_diagonal(const BlockMatrix& A, const Coupling* coupling,
                                     std::span<const std::uint8_t> is_free);

  LaneBlocks preconditioner_;  ///< zero where a row is not free, so that nothing goes there
  std::vector<std::uint8_t> is_definite_;
  LaneVectors x_, residual_, step_, product_;
  std::vector<double> partial_;
};

}  // namespace selvage::sim
