#include "sim/springs/length_check.h"

#include <algorithm>

#include "sim/base/parallel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sim/springs/length_check.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "sim/base/lane_table-inl.h"

HWY_BEFORE_NAMESPACE();
namespace selvage::sim::HWY_NAMESPACE {

// What an impulse has brought to a limit ends there but for rounding, of the positions too, and is not looked at again.
constexpr double kSlack = 0x1p-46;

/// `rest_squared` is null where the lengths at x_t0 are the reference.
void CheckLengths(const LaneTable& table, const double* rest_squared, const LaneVectors& starts,
                  const LaneVectors& ends, double share, Eigen::Index begin, Eigen::Index end,
                  std::uint8_t* is_outside) {
  const Real d;
  const Axes x_t0(starts), x_t1(ends);
  const double below = 1 - share - kSlack, above = 1 + share + kSlack;
  const Value shortest = hn::Set(d, below * below), longest = hn::Set(d, above * above);
  for (Eigen::Index row = begin; row < end; row += VectorRows()) {
    const Vector start_i = ReadRows(x_t0, row), end_i = ReadRows(x_t1, row);
    ForEachSlot(table, row, [&](std::size_t entry, auto read) HWY_ATTR SELVAGE_INLINE_LAMBDA {
      const Vector line = lanes::Minus<Real>(read(x_t1), end_i);
      const Value squared = lanes::Dot<Real>(line, line);
      Value reference;
      if (rest_squared != nullptr) {
        reference = hn::LoadU(d, rest_squared + entry);
      } else {
        const Vector start = lanes::Minus<Real>(read(x_t0), start_i);
        reference = lanes::Dot<Real>(start, start);
      }
      const auto inside =
          hn::And(hn::Ge(squared, hn::Mul(shortest, reference)), hn::Le(squared, hn::Mul(longest, reference)));
      if (hn::AllTrue(d, inside)) return;
      std::uint8_t outside[8];
      hn::StoreMaskBits(d, hn::Not(inside), outside);
      for (std::size_t lane = 0; lane < hn::Lanes(d); ++lane) {
        const std::int32_t spring = table.item[entry + lane];
        if (has_lane(outside[0], lane) && spring != LaneTable::kNone) is_outside[spring] = 1;
      }
    });
  }
}

}  // namespace selvage::sim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace selvage::sim {

HWY_EXPORT(CheckLengths);

LengthCheck::LengthCheck(const SpringSystem& springs) {
  std::vector<std::vector<LaneNeighbour>> neighbours(static_cast<std::size_t>(springs.vertex_count()));
  std::vector<double> rest_squared_m2;
  for (const Spring& spring : springs.springs()) {
    if (spring.kind != SpringKind::kBending) {
      neighbours[static_cast<std::size_t>(spring.a)].push_back(
          {spring.b, static_cast<std::int32_t>(rest_squared_m2.size())});
    }
    rest_squared_m2.push_back(spring.rest_length_m * spring.rest_length_m);
  }
  table_ = make_lane_table(neighbours);
  rest_squared_m2_ = table_.spread(rest_squared_m2);
}

void LengthCheck::find_outside(const LaneVectors& x_t0, const LaneVectors& x_t1, Reference reference, double share,
                               std::vector<std::uint8_t>& is_outside) const {
  std::ranges::fill(is_outside, std::uint8_t{0});
  const double* const rest_squared = reference == Reference::kRestLength ? rest_squared_m2_.data() : nullptr;
  parallel_blocks(x_t0.rows(), [&](Eigen::Index begin, Eigen::Index end) {
    HWY_DYNAMIC_DISPATCH(CheckLengths)(table_, rest_squared, x_t0, x_t1, share, begin, end, is_outside.data());
  });
}

}  // namespace selvage::sim
#endif
