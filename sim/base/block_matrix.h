// Symmetric matrices of 3 by 3 blocks between vertices, in blocks of lanes: the linear part of implicit dynamics.
#pragma once

#include <array>
#include <vector>

#include "sim/base/lane_table.h"

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

/// Symmetric blocks, kLanes of them at once: of each element those of eight blocks that follow one another.
class LaneBlocks {
 public:
  /// All zero; whole vectors may be read.
  void reset(std::size_t count) { elements_.assign((count + kLanes - 1) / kLanes * kStride, 0); }
  [[nodiscard]] SymmetricBlock get(std::size_t i) const {
    SymmetricBlock block;
    for (std::size_t k = 0; k < block.size(); ++k) block[k] = elements_[place(i) + k * kLanes];
    return block;
  }
  void set(std::size_t i, const SymmetricBlock& block) {
    for (std::size_t k = 0; k < block.size(); ++k) elements_[place(i) + k * kLanes] = block[k];
  }
  void add(std::size_t i, const SymmetricBlock& block) {
    for (std::size_t k = 0; k < block.size(); ++k) elements_[place(i) + k * kLanes] += block[k];
  }
  /// Element xx of block i and of those that follow it; the next element stands kLanes farther.
  [[nodiscard]] const double* at(std::size_t i) const { return elements_.data() + place(i); }

 private:
  static constexpr std::size_t kStride = std::tuple_size_v<SymmetricBlock> * kLanes;
  [[nodiscard]] static std::size_t place(std::size_t i) { return i / kLanes * kStride + i % kLanes; }

  std::vector<double> elements_;
};

/// Row i holds a diagonal block and one block for each of its neighbours. The pattern is fixed; the caller fills the
/// values, the same block at (i, j) and (j, i).
class BlockMatrix {
 public:
  BlockMatrix() = default;
  /// neighbours[i] are unique, without i itself, and symmetric: j lists i where i lists j.
  explicit BlockMatrix(const std::vector<std::vector<VertexId>>& neighbours);

  [[nodiscard]] Eigen::Index rows() const { return rows_; }
  /// The entry of a neighbour of row i. REQUIRES that it is one. O(neighbours).
  [[nodiscard]] std::size_t find(VertexId i, VertexId neighbour) const;
  /// Makes a row zero. Rows may be cleared and filled at the same time by different threads.
  void clear_row(Eigen::Index i);
  void add_off_diagonal(std::size_t entry, const SymmetricBlock& block) { off_diagonal_.add(entry, block); }
  void add_diagonal(Eigen::Index i, const SymmetricBlock& block) { diagonal_.add(static_cast<std::size_t>(i), block); }
  [[nodiscard]] SymmetricBlock diagonal(Eigen::Index i) const { return diagonal_.get(static_cast<std::size_t>(i)); }

  // For loops in lanes (conjugate_gradients.cpp).
  [[nodiscard]] const LaneTable& table() const { return table_; }
  [[nodiscard]] const LaneBlocks& off_diagonals() const { return off_diagonal_; }  ///< by entry; zero where none is
  [[nodiscard]] const LaneBlocks& diagonals() const { return diagonal_; }

 private:
  Eigen::Index rows_ = 0;
  LaneTable table_;
  LaneBlocks off_diagonal_, diagonal_;
};

}  // namespace selvage::sim
