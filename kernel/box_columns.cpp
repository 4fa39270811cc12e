#include "kernel/box_columns.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernel/box_columns.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace selvage::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Real = hn::CappedTag<double, kVectorSlack>;
using Word = hn::RebindToUnsigned<Real>;
using Integer = hn::RebindToSigned<Real>;

/// One box against as many rows as a vector holds.
class OverlapTest {
 public:
  OverlapTest(const BoxColumns& boxes, const Box& box) : boxes_(boxes) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      lower_[axis] = box.lower[axis];
      upper_[axis] = box.upper[axis];
    }
  }
  /// The rows from `row` on whose boxes overlap; those at or beyond `end` do not.
  auto operator()(std::size_t row, std::size_t end) const {
    const auto along = [&](std::size_t axis) HWY_ATTR {
      return hn::And(hn::Le(hn::Set(Real(), lower_[axis]), hn::LoadU(Real(), &boxes_.upper[axis][row])),
                     hn::Le(hn::LoadU(Real(), &boxes_.lower[axis][row]), hn::Set(Real(), upper_[axis])));
    };
    return hn::And(hn::And(hn::FirstN(Real(), end - row), along(0)), hn::And(along(1), along(2)));
  }

 private:
  const BoxColumns& boxes_;
  std::array<double, 3> lower_, upper_;
};

std::size_t overlaps(const BoxColumns& boxes, std::span<const RowRange> ranges, const Box& box, std::uint64_t first_key,
                     std::uint64_t* out) {
  const OverlapTest overlap(boxes, box);
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

template <std::size_t kCorners, std::size_t kOwnCorners>
std::size_t pairs(const BoxColumns& boxes, const CornerColumns<kCorners>& corners, std::size_t begin, const Box& box,
                  const std::array<VertexId, kOwnCorners>& own_corners, std::uint64_t own_key, std::uint64_t* out) {
  const OverlapTest overlap(boxes, box);
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

std::size_t vf_pairs(const BoxColumns& boxes, const CornerColumns<3>& corners, std::size_t begin, const Box& box,
                     const std::array<VertexId, 1>& own_corners, std::uint64_t own_key, std::uint64_t* out) {
  return pairs(boxes, corners, begin, box, own_corners, own_key, out);
}
std::size_t ee_pairs(const BoxColumns& boxes, const CornerColumns<2>& corners, std::size_t begin, const Box& box,
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

std::size_t find_overlaps(const BoxColumns& boxes, std::span<const RowRange> ranges, const Box& box,
                          std::uint64_t first_key, std::uint64_t* out) {
  return HWY_DYNAMIC_DISPATCH(overlaps)(boxes, ranges, box, first_key, out);
}
std::size_t find_pairs(const BoxColumns& boxes, const CornerColumns<3>& corners, std::size_t begin, const Box& box,
                       const std::array<VertexId, 1>& own_corners, std::uint64_t own_key, std::uint64_t* out) {
  return HWY_DYNAMIC_DISPATCH(vf_pairs)(boxes, corners, begin, box, own_corners, own_key, out);
}
std::size_t find_pairs(const BoxColumns& boxes, const CornerColumns<2>& corners, std::size_t begin, const Box& box,
                       const std::array<VertexId, 2>& own_corners, std::uint64_t own_key, std::uint64_t* out) {
  return HWY_DYNAMIC_DISPATCH(ee_pairs)(boxes, corners, begin, box, own_corners, own_key, out);
}

void BoxColumns::resize(std::size_t row_count) {
  row_count_ = row_count;
  const std::size_t padded = row_count + kVectorSlack;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    lower[axis].assign(padded, Box::kInfinity);
    upper[axis].assign(padded, -Box::kInfinity);
  }
  key.assign(padded, 0);
}

void BoxColumns::reuse(std::size_t row_count) {
  if (key.size() < row_count + kVectorSlack) resize(2 * row_count);
  row_count_ = row_count;
}

void BoxColumns::set(std::size_t row, const Box& box) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    lower[axis][row] = box.lower[axis];
    upper[axis][row] = box.upper[axis];
  }
}

Box BoxColumns::row(std::size_t row) const {
  Box box;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    box.lower[axis] = lower[axis][row];
    box.upper[axis] = upper[axis][row];
  }
  return box;
}

}  // namespace selvage
#endif
