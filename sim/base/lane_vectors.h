// One number a vertex, or three in columns, so that the vertices of a block of lanes are read and written at once.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "kernel/types.h"

namespace selvage::sim {

/// Vertices are taken in blocks of this many: a whole number of vectors on every vector unit.
inline constexpr Eigen::Index kLanes = 8;

/// Some of the lanes of a block: bit k is lane k.
using LaneMask = std::uint8_t;
[[nodiscard]] inline bool has_lane(LaneMask lanes, std::size_t lane) { return (lanes >> lane & 1U) != 0; }
[[nodiscard]] inline LaneMask only_lane(std::size_t lane) { return static_cast<LaneMask>(1U << lane); }

/// Whole blocks may be read, zero beyond the last row.
class LaneScalars {
 public:
  void copy(std::span<const double> values);
  [[nodiscard]] double operator[](Eigen::Index i) const { return column_[static_cast<std::size_t>(i)]; }
  [[nodiscard]] const double* data() const { return column_.data(); }

 private:
  std::vector<double> column_;
};

/// Zero in rows that were not set. Whole blocks may be read from kLanes rows before the first to kLanes after the last,
/// and written where they hold one row at least.
class LaneVectors {
  using Columns = Eigen::Matrix<double, Eigen::Dynamic, 3>;

 public:
  /// Keeps the rows where their number stays; all are zero otherwise.
  void resize(Eigen::Index rows) {
    if (rows == rows_ && column_.size() > 0) return;
    rows_ = rows;
    column_ = Columns::Zero((rows + kLanes - 1) / kLanes * kLanes + 2 * kLanes, 3);
  }
  void set_zero() { column_.setZero(); }
  void copy(const Positions& x);
  void copy_to(Positions& x) const;  ///< REQUIRES as many rows
  [[nodiscard]] Eigen::Index rows() const { return rows_; }
  [[nodiscard]] Columns::RowXpr row(Eigen::Index i) { return column_.row(kLanes + i); }
  [[nodiscard]] Columns::ConstRowXpr row(Eigen::Index i) const { return column_.row(kLanes + i); }
  /// Where row 0 of an axis stands; the others follow.
  [[nodiscard]] double* axis(int k) { return column_.data() + k * column_.rows() + kLanes; }
  [[nodiscard]] const double* axis(int k) const { return column_.data() + k * column_.rows() + kLanes; }

 private:
  Columns column_;
  Eigen::Index rows_ = 0;
};

}  // namespace selvage::sim
