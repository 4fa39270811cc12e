// Boxes in columns, so that one box is tested against several at once (SIMD, chosen at run time).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "kernel/box.h"

namespace selvage {

/// Answers are written in whole vectors: `out` has room for this many entries more than there are rows in the range.
inline constexpr std::size_t kVectorSlack = 8;

/// A list of boxes, each with a key. A row that has not been set holds nothing and overlaps nothing.
struct BoxColumns {
  struct Bounds {
    std::array<std::vector<double>, 3> lower, upper;

    void set(std::size_t row, const Box& box);
    [[nodiscard]] Box row(std::size_t row) const;
    void copy_row(std::size_t row, const Bounds& from, std::size_t from_row) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        lower[axis][row] = from.lower[axis][from_row];
        upper[axis][row] = from.upper[axis][from_row];
      }
    }
  };
  Bounds t0, t1;  ///< swept boxes are in t0 alone
  std::vector<std::uint64_t> key;

  /// No row is set then, and boxes are swept.
  void resize(std::size_t row_count);
  /// As resize and hold, but what the rows hold is unspecified and memory is never given back.
  void reuse(std::size_t row_count, MotionBoxes boxes);
  /// What kind of boxes the rows hold from now on; t1 is to be set anew where they move.
  void hold(MotionBoxes boxes);
  [[nodiscard]] MotionBoxes boxes() const { return boxes_; }
  /// Of `from`, which holds the same kind. Here, to be inlined: a search copies each partner that a cluster has.
  void copy_row(std::size_t row, const BoxColumns& from, std::size_t from_row) {
    t0.copy_row(row, from.t0, from_row);
    if (boxes_ == MotionBoxes::kMoving) t1.copy_row(row, from.t1, from_row);
  }
  [[nodiscard]] MovingBox row(std::size_t row) const;
  [[nodiscard]] std::size_t row_count() const { return row_count_; }

 private:
  std::size_t row_count_ = 0;
  MotionBoxes boxes_ = MotionBoxes::kSwept;
};

struct RowRange {
  std::size_t begin, end;
};

/// Writes the keys of the rows in `ranges` whose box overlaps `box` and whose key is at least `first_key`, in the order
/// of the ranges; returns their number. REQUIRES keys below 2^63.
std::size_t find_overlaps(const BoxColumns& boxes, std::span<const RowRange> ranges, const MovingBox& box,
                          std::uint64_t first_key, std::uint64_t* out);

/// The vertices of the rows' features; kCorners is 2 for edges and 3 for faces.
template <std::size_t kCorners>
using CornerColumns = std::array<std::vector<std::uint64_t>, kCorners>;

/// The same for the rows from `begin` on, with the corner columns beside them: rows that share one of `own_corners` are
/// left out, and every key is joined with `own_key` by OR.
std::size_t find_pairs(const BoxColumns& boxes, const CornerColumns<3>& corners, std::size_t begin,
                       const MovingBox& box, const std::array<VertexId, 1>& own_corners, std::uint64_t own_key,
                       std::uint64_t* out);
std::size_t find_pairs(const BoxColumns& boxes, const CornerColumns<2>& corners, std::size_t begin,
                       const MovingBox& box, const std::array<VertexId, 2>& own_corners, std::uint64_t own_key,
                       std::uint64_t* out);

}  // namespace selvage
