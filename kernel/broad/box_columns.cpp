#include "kernel/broad/box_columns.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernel/broad/box_columns.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace selvage::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Real = hn::CappedTag<double, kVectorSlack>;
using Word = hn::RebindToUnsigned<Real>;
using Integer = hn::RebindToSigned<Real>;

/// One box against as many rows as a vector holds.
template <MotionBoxes kBoxes>
class OverlapTest {
 public:
  OverlapTest(const BoxColumns& boxes, const MovingBox& box) : boxes_(boxes), box_(box) {}
  /// The rows from `row` on whose boxes overlap; those at or beyond `end` do not.
  auto operator()(std::size_t row, std::size_t end) const {
    return hn::And(hn::And(hn::FirstN(Real(), end - row), Along(0, row)), hn::And(Along(1, row), Along(2, row)));
  }

 private:
  using Mask = hn::Mask<Real>;

  HWY_INLINE static Mask Reaches(double upper, const std::vector<double>& lower, std::size_t row) {
    return hn::Le(hn::LoadU(Real(), &lower[row]), hn::Set(Real(), upper));
  }
  HWY_INLINE static Mask Reaches(const std::vector<double>& upper, double lower, std::size_t row) {
    return hn::Le(hn::Set(Real(), lower), hn::LoadU(Real(), &upper[row]));
  }
  /// As overlap() of moving boxes along one axis.
  HWY_INLINE Mask Along(std::size_t axis, std::size_t row) const {
    Mask up = Reaches(box_.t0.upper[axis], boxes_.t0.lower[axis], row);
    Mask down = Reaches(boxes_.t0.upper[axis], box_.t0.lower[axis], row);
    if constexpr (kBoxes == MotionBoxes::kMoving) {
      up = hn::Or(up, Reaches(box_.t1.upper[axis], boxes_.t1.lower[axis], row));
      down = hn::Or(down, Reaches(boxes_.t1.upper[axis], box_.t1.lower[axis], row));
    }
    return hn::And(up, down);
  }

  const BoxColumns& boxes_;
  const MovingBox& box_;
};

template <MotionBoxes kBoxes>
std::size_t overlaps_of(const BoxColumns& boxes, std::span<const RowRange> ranges, const MovingBox& box,
                        std::uint64_t first_key, std::uint64_t* out) {
  const OverlapTest<kBoxes> overlap(boxes, box);
  const auto last_excluded = hn::Set(Integer(), static_cast<std::int64_t>(first_key) - 1);
  std::uint64_t* out_end = out;
  for (const RowRange& range : ranges) {
    for (std::size_t row = range.begin; row < range.end; row += hn::Lanes(Real())) {
      const auto key = hn::LoadU(Word(), &boxes.key[row]);
      const auto late = hn::RebindMask(Word(), hn::Gt(hn::BitCast(Integer(), key), last_excluded));
      const auto found = hn::And(hn::RebindMask(Word(), overlap(row, range.end)), late);
      out_end += hn::CompressStore(key, found, Word(), out_end);
    }
  }
  return static_cast<std::size_t>(out_end - out);
}

std::size_t overlaps(const BoxColumns& boxes, std::span<const RowRange> ranges, const MovingBox& box,
                     std::uint64_t first_key, std::uint64_t* out) {
  const auto find =
      boxes.boxes() == MotionBoxes::kMoving ? overlaps_of<MotionBoxes::kMoving> : overlaps_of<MotionBoxes::kSwept>;
  return find(boxes, ranges, box, first_key, out);
}

template <MotionBoxes kBoxes, std::size_t kCorners, std::size_t kOwnCorners>
std::size_t pairs_of(const BoxColumns& boxes, const CornerColumns<kCorners>& corners, std::size_t begin,
                     const MovingBox& box, const std::array<VertexId, kOwnCorners>& own_corners, std::uint64_t own_key,
                     std::uint64_t* out) {
  const OverlapTest<kBoxes> overlap(boxes, box);
  const auto own = hn::Set(Word(), own_key);
  const std::size_t end = boxes.row_count();
  std::uint64_t* out_end = out;
  for (std::size_t row = begin; row < end; row += hn::Lanes(Real())) {
    auto found = hn::RebindMask(Word(), overlap(row, end));
    if (hn::AllFalse(Word(), found)) continue;
    for (std::size_t k = 0; k < kCorners; ++k) {
      const auto corner = hn::LoadU(Word(), &corners[k][row]);
      for (const VertexId own_corner : own_corners) {
        found = hn::AndNot(hn::Eq(corner, hn::Set(Word(), static_cast<std::uint64_t>(own_corner))), found);
      }
    }
    out_end += hn::CompressStore(hn::Or(own, hn::LoadU(Word(), &boxes.key[row])), found, Word(), out_end);
  }
  return static_cast<std::size_t>(out_end - out);
}

template <std::size_t kCorners, std::size_t kOwnCorners>
std::size_t pairs(const BoxColumns& boxes, const CornerColumns<kCorners>& corners, std::size_t begin,
                  const MovingBox& box, const std::array<VertexId, kOwnCorners>& own_corners, std::uint64_t own_key,
                  std::uint64_t* out) {
  const auto find = boxes.boxes() == MotionBoxes::kMoving ? pairs_of<MotionBoxes::kMoving, kCorners, kOwnCorners>
                                                          : pairs_of<MotionBoxes::kSwept, kCorners, kOwnCorners>;
  return find(boxes, corners, begin, box, own_corners, own_key, out);
}

std::size_t vf_pairs(const BoxColumns& boxes, const CornerColumns<3>& corners, std::size_t begin, const MovingBox& box,
                     const std::array<VertexId, 1>& own_corners, std::uint64_t own_key, std::uint64_t* out) {
  return pairs(boxes, corners, begin, box, own_corners, own_key, out);
}
std::size_t ee_pairs(const BoxColumns& boxes, const CornerColumns<2>& corners, std::size_t begin, const MovingBox& box,
                     const std::array<VertexId, 2>& own_corners, std::uint64_t own_key, std::uint64_t* out) {
  return pairs(boxes, corners, begin, box, own_corners, own_key, out);
}

}  // namespace selvage::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace selvage {

HWY_EXPORT(overlaps);
HWY_EXPORT(vf_pairs);
HWY_EXPORT(ee_pairs);

std::size_t find_overlaps(const BoxColumns& boxes, std::span<const RowRange> ranges, const MovingBox& box,
                          std::uint64_t first_key, std::uint64_t* out) {
  return HWY_DYNAMIC_DISPATCH(overlaps)(boxes, ranges, box, first_key, out);
}
std::size_t find_pairs(const BoxColumns& boxes, const CornerColumns<3>& corners, std::size_t begin,
                       const MovingBox& box, const std::array<VertexId, 1>& own_corners, std::uint64_t own_key,
                       std::uint64_t* out) {
  return HWY_DYNAMIC_DISPATCH(vf_pairs)(boxes, corners, begin, box, own_corners, own_key, out);
}
std::size_t find_pairs(const BoxColumns& boxes, const CornerColumns<2>& corners, std::size_t begin,
                       const MovingBox& box, const std::array<VertexId, 2>& own_corners, std::uint64_t own_key,
                       std::uint64_t* out) {
  return HWY_DYNAMIC_DISPATCH(ee_pairs)(boxes, corners, begin, box, own_corners, own_key, out);
}

void BoxColumns::resize(std::size_t row_count) {
  row_count_ = row_count;
  boxes_ = MotionBoxes::kSwept;
  const std::size_t padded = row_count + kVectorSlack;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    t0.lower[axis].assign(padded, Box::kInfinity);
    t0.upper[axis].assign(padded, -Box::kInfinity);
  }
  t1 = {};
  key.assign(padded, 0);
}

void BoxColumns::reuse(std::size_t row_count, MotionBoxes boxes) {
  if (key.size() < row_count + kVectorSlack) resize(2 * row_count);
  row_count_ = row_count;
  hold(boxes);
}

void BoxColumns::hold(MotionBoxes boxes) {
  for (std::size_t axis = 0; boxes == MotionBoxes::kMoving && axis < 3; ++axis) {
    t1.lower[axis].resize(key.size(), Box::kInfinity);
    t1.upper[axis].resize(key.size(), -Box::kInfinity);
  }
  boxes_ = boxes;
}

MovingBox BoxColumns::row(std::size_t row) const {
  return {t0.row(row), (boxes_ == MotionBoxes::kMoving ? t1 : t0).row(row)};
}

void BoxColumns::Bounds::set(std::size_t row, const Box& box) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    lower[axis][row] = box.lower[axis];
    upper[axis][row] = box.upper[axis];
  }
}

Box BoxColumns::Bounds::row(std::size_t row) const {
  Box box;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    box.lower[axis] = lower[axis][row];
    box.upper[axis] = upper[axis][row];
  }
  return box;
}

}  // namespace selvage
#endif
