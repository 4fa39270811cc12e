#include "kernel/lanes/lane_motion.h"

#include <algorithm>
#include <cmath>

#include "kernel/arithmetic/power_of_two.h"

namespace selvage::detail {

namespace {

/// Nonzero coordinates from here on differ by 2^-753 or not at all, which pairs can be scaled by without a loss.
constexpr double kLeastExact = 0x1p-700;
/// Rows are off by 2^-1074 where scaling underflows; magnified no further than this, that is nothing to float32.
constexpr int kMaxMagnified = 1000;

}  // namespace

LanePairs::LanePairs(const Mesh& mesh, std::span<const VfCandidate> pairs)
    : kind_(PairKind::kVf), count_(pairs.size()) {
  for (std::size_t i = 0; i < count_; ++i) {
    const auto& corners = mesh.faces[static_cast<std::size_t>(pairs[i].face)];
    vertex_[0][i] = static_cast<std::uint32_t>(pairs[i].vertex);
    for (std::size_t k = 0; k < 3; ++k) vertex_[k + 1][i] = static_cast<std::uint32_t>(corners[k]);
  }
  pad();
}

LanePairs::LanePairs(const Mesh& mesh, std::span<const EeCandidate> pairs)
    : kind_(PairKind::kEe), count_(pairs.size()) {
  for (std::size_t i = 0; i < count_; ++i) {
    const auto &a = mesh.edges[static_cast<std::size_t>(pairs[i].a)],
               &b = mesh.edges[static_cast<std::size_t>(pairs[i].b)];
    for (std::size_t k = 0; k < 2; ++k) {
      vertex_[k][i] = static_cast<std::uint32_t>(a[k]);
      vertex_[k + 2][i] = static_cast<std::uint32_t>(b[k]);
    }
  }
  pad();
}

LanePairs::LanePairs(const LanePairs& all, const PairNumbers& numbers) : kind_(all.kind_), count_(numbers.count) {
  for (std::size_t k = 0; k < 4; ++k) {
    for (std::size_t i = 0; i < count_; ++i) vertex_[k][i] = all.vertex_[k][numbers.place[i]];
  }
  pad();
}

void LanePairs::pad() {
  for (auto& of_pairs : vertex_) {
    std::fill_n(of_pairs.begin() + static_cast<std::ptrdiff_t>(count_), kMaxLanes,
                count_ > 0 ? of_pairs[count_ - 1] : 0);
  }
}

LaneMotion::LaneMotion(const PositionsRef& V_t0, const PositionsRef& V_t1) {
  double largest = 0;
  for (const PositionsRef* V : {&V_t0, &V_t1}) {
    for (Eigen::Index v = 0; v < V->rows(); ++v) {
      for (Eigen::Index axis = 0; axis < 3; ++axis) {
        const double size = std::fabs((*V)(v, axis));
        is_valid_ &= size <= kMaxCoordinate;  // false for NaN
        largest = std::max(largest, size);
      }
    }
  }
  if (!is_valid_ || V_t0.rows() == 0) return;
  exponent = largest > 0 ? exponent_of(largest) : 0;
  fill_rows(V_t0, V_t1);
  fill_near_rows();
}

void LaneMotion::fill_rows(const PositionsRef& V_t0, const PositionsRef& V_t1) {
  rows.resize(static_cast<std::size_t>(V_t0.rows()));
  // In two factors, because 2^-exponent need not be a double (times_power).
  const double first = power_of_two(-exponent / 2), second = power_of_two(-exponent - -exponent / 2);
  const auto scaled = [this, first, second](double value) {
    const double result = (value * first) * second;
    is_exact_ &= value == 0 || std::fabs(result) >= kLeastExact;
    return result;
  };
  for (std::size_t v = 0; v < rows.size(); ++v) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto i = static_cast<Eigen::Index>(v), k = static_cast<Eigen::Index>(axis);
      rows[v][axis] = scaled(V_t0(i, k));
      rows[v][axis + 3] = scaled(V_t1(i, k));
    }
  }
}

void LaneMotion::fill_near_rows() {
  Row low = rows.front(), high = rows.front();
  for (const Row& row : rows) {
    for (std::size_t i = 0; i < 6; ++i) {
      low[i] = std::min(low[i], row[i]);
      high[i] = std::max(high[i], row[i]);
    }
  }
  std::array<double, 3> middle;
  double reach = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double lowest = std::min(low[axis], low[axis + 3]), highest = std::max(high[axis], high[axis + 3]);
    middle[axis] = 0.5 * (lowest + highest);
    reach = std::max(reach, std::max(highest - middle[axis], middle[axis] - lowest));
  }
  const int magnified = reach > 0 ? std::min(-exponent_of(reach), kMaxMagnified) : 0;
  near_exponent = exponent - magnified;
  const double factor = power_of_two(magnified);
  near_rows.resize(rows.size());
  for (std::size_t v = 0; v < rows.size(); ++v) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      near_rows[v][axis] = static_cast<float>((rows[v][axis] - middle[axis]) * factor);
      near_rows[v][axis + 4] = static_cast<float>((rows[v][axis + 3] - middle[axis]) * factor);
    }
  }
}

}  // namespace selvage::detail
