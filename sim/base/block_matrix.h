// Symmetric matrices of 3 by 3 blocks between vertices, and conjugate gradients on them: the linear part of implicit
// dynamics.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "kernel/types.h"

namespace selvage::sim {

/// A symmetric 3 by 3 block, row by row from the diagonal: xx, xy, xz, yy, yz, zz.
using SymmetricBlock = std::array<double, 6>;

/// block += scale I.
inline void add_identity(double scale, SymmetricBlock& block) {
  block[0] += scale;
  block[3] += scale;
  block[5] += scale;
}

/// block += scale n n^T.
inline void add_outer(double scale, double x, double y, double z, SymmetricBlock& block) {
  block[0] += scale * x * x;
  block[1] += scale * x * y;
  block[2] += scale * x * z;
  block[3] += scale * y * y;
  block[4] += scale * y * z;
  block[5] += scale * z * z;
}

/// The sum of the products of all coordinates, row by row in order: the bits do not depend on the number of threads.
[[nodiscard]] double dot(const Positions& a, const Positions& b);

/// Row i holds a diagonal block and one block for each of its neighbours, in increasing order. The pattern is fixed;
/// the caller fills the values, the same block at (i, j) and (j, i).
class BlockMatrix {
 public:
  BlockMatrix() = default;
  /// neighbours[i] are sorted and unique, without i itself, and symmetric: j lists i where i lists j.
  explicit BlockMatrix(const std::vector<std::vector<VertexId>>& neighbours);

  [[nodiscard]] Eigen::Index rows() const { return static_cast<Eigen::Index>(diagonal_.size()); }
  /// Where row i's blocks stand in neighbour() and off_diagonal(): [begin(i), begin(i + 1)).
  [[nodiscard]] std::size_t begin(Eigen::Index i) const { return begin_[static_cast<std::size_t>(i)]; }
  [[nodiscard]] VertexId neighbour(std::size_t slot) const { return neighbour_[slot]; }
  /// The slot of a neighbour of row i. REQUIRES that it is one.
  [[nodiscard]] std::size_t find(VertexId i, VertexId neighbour) const {
    std::size_t slot = begin(i);
    while (neighbour_[slot] != neighbour) ++slot;
    return slot;
  }
  SymmetricBlock& off_diagonal(std::size_t slot) { return off_diagonal_[slot]; }
  SymmetricBlock& diagonal(Eigen::Index i) { return diagonal_[static_cast<std::size_t>(i)]; }
  [[nodiscard]] const SymmetricBlock& diagonal(Eigen::Index i) const { return diagonal_[static_cast<std::size_t>(i)]; }

  /// result = A x, row by row in parallel with a fixed order in each: same bits for any thread count.
  void multiply(const Positions& x, Positions& result) const;

 private:
  std::vector<std::size_t> begin_{0};
  std::vector<VertexId> neighbour_;
  std::vector<SymmetricBlock> off_diagonal_, diagonal_;
};

/// What a matrix has beside its blocks; symmetric.
class Coupling {
 public:
  virtual ~Coupling() = default;
  /// result += (this) x.
  virtual void add_product(const Positions& x, Positions& result) const = 0;
  /// block += the diagonal block at row i of this.
  virtual void add_diagonal(Eigen::Index i, SymmetricBlock& block) const = 0;
};

struct ConjugateGradientsResult {
  std::int32_t iterations = 0;
  bool converged = false;  ///< false after max_iterations, or where a number is not finite
  bool definite = true;    ///< false where A was found not to be positive definite on the free rows: x is of no use
};

/// Solves A x = rhs on the rows with is_free; the others of x become zero, and A acts as if their rows and columns were
/// not there. The preconditioner is the inverse of the diagonal blocks; ends
/// when the residual is `relative_residual` of rhs in its norm. `coupling`, where it is not null, is a part of A.
/// Deterministic for any thread count, as the coupling is.
ConjugateGradientsResult solve_by_conjugate_gradients(const BlockMatrix& A, const Coupling* coupling,
                                                      std::span<const std::uint8_t> is_free, const Positions& rhs,
                                                      double relative_residual, std::int32_t max_iterations,
                                                      Positions& x);

}  // namespace selvage::sim
