#include "sim/springs/stabilizer_lanes.h"

#include <cmath>
#include <limits>

#include "sim/base/parallel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sim/springs/stabilizer_lanes.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "sim/base/lane_table-inl.h"

HWY_BEFORE_NAMESPACE();
namespace selvage::sim::HWY_NAMESPACE {

/// The sum of weight times row over the entries from `row` on.
HWY_INLINE Vector WeightedSum(const LaneTable& table, const std::vector<double>& weight, const Axes& from,
                              Eigen::Index row) {
  Vector sum = ZeroRows();
  ForEachSlot(table, row, [&](std::size_t entry, auto read) HWY_ATTR SELVAGE_INLINE_LAMBDA {
    sum = lanes::Plus<Real>(sum, lanes::Times<Real>(ReadEntries(weight, entry), read(from)));
  });
  return sum;
}

/// Of the stabilisers from `row` on, where they are: their bows, and c over their squared length.
struct Bows {
  Vector bow;
  Value c_by_squared;
};
HWY_INLINE Bows FindBows(const LaneTable& points, const std::vector<double>& weight, const StabilizerColumns& columns,
                         const ImpulseShares& shares, const Axes& x, Eigen::Index row) {
  const Real d;
  const auto entry = static_cast<std::size_t>(row);
  const Vector bow = WeightedSum(points, weight, x, row);
  const Value c = hn::Add(hn::Mul(hn::Set(d, shares.damping_s), ReadEntries(columns.damping_n_s_m, entry)),
                          hn::Mul(hn::Set(d, shares.stiffness_s2), ReadEntries(columns.stiffness_n_m, entry)));
  const Value squared = hn::Add(lanes::Dot<Real>(bow, bow), ReadEntries(columns.straight_m2, entry));
  const auto apart = hn::Ge(squared, hn::Set(d, std::numeric_limits<double>::min()));
  return {bow, hn::IfThenElseZero(apart, hn::Div(c, squared))};
}

void ScaleBows(const LaneTable& points, const std::vector<double>& weight, const StabilizerColumns& columns,
               const ImpulseShares& shares, const LaneVectors& positions, Eigen::Index begin, Eigen::Index end,
               LaneVectors& scaled) {
  const Axes x(positions);
  for (Eigen::Index row = begin; row < end; row += VectorRows()) {
    const Bows bows = FindBows(points, weight, columns, shares, x, row);
    WriteRows(lanes::Times<Real>(hn::Sqrt(bows.c_by_squared), bows.bow), scaled, row);
  }
}

void AddDiagonal(const LaneTable& ends, const std::vector<double>& weight, const LaneVectors& scaled_bows,
                 Eigen::Index begin, Eigen::Index end, LaneVectors& diagonal) {
  const Axes bow(scaled_bows), before(diagonal);
  for (Eigen::Index row = begin; row < end; row += VectorRows()) {
    Vector sum = ReadRows(before, row);
    ForEachSlot(ends, row, [&](std::size_t entry, auto read) HWY_ATTR SELVAGE_INLINE_LAMBDA {
      const Vector share = lanes::Times<Real>(ReadEntries(weight, entry), read(bow));
      sum = lanes::Plus<Real>(sum, lanes::Product<Real>(share, share));
    });
    WriteRows(sum, diagonal, row);
  }
}

void Oppose(const LaneTable& points, const std::vector<double>& weight, const StabilizerColumns& columns,
            const ImpulseShares& shares, const LaneVectors& positions, const LaneVectors& velocities,
            Eigen::Index begin, Eigen::Index end, LaneVectors& impulse) {
  const Axes x(positions), v(velocities);
  for (Eigen::Index row = begin; row < end; row += VectorRows()) {
    const Bows bows = FindBows(points, weight, columns, shares, x, row);
    const Value rate = lanes::Dot<Real>(bows.bow, WeightedSum(points, weight, v, row));
    WriteRows(lanes::Times<Real>(hn::Mul(bows.c_by_squared, rate), bows.bow), impulse, row);
  }
}

void AddProduct(const LaneTable& ends, const std::vector<double>& weight, const LaneVectors& impulses,
                Eigen::Index begin, Eigen::Index end, LaneVectors& product) {
  const Axes impulse(impulses), before(product);
  for (Eigen::Index row = begin; row < end; row += VectorRows()) {
    WriteRows(lanes::Plus<Real>(ReadRows(before, row), WeightedSum(ends, weight, impulse, row)), product, row);
  }
}

}  // namespace selvage::sim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace selvage::sim {
namespace {

// What a solution neglects where stabilisers are weak is at most this part of how far it goes from its guess, which is
// some half of the damping impulses; it may end at a twentieth of them in any case (kVelocityResidual). 0.021 for the
// stiffnesses of sim/scenes/curtain.toml at any resolution.
constexpr double kWeak = 1.0 / 32;

}  // namespace

HWY_EXPORT(ScaleBows);
HWY_EXPORT(AddDiagonal);
HWY_EXPORT(Oppose);
HWY_EXPORT(AddProduct);

StabilizerLanes::StabilizerLanes(const StabilizerSystem& stabilizers, std::int32_t vertex_count)
    : row_sum_n_m_(static_cast<std::size_t>(vertex_count)), row_sum_n_s_m_(row_sum_n_m_.size()) {
  const std::vector<Stabilizer>& all = stabilizers.stabilizers();
  std::vector<std::vector<LaneNeighbour>> points(all.size()), ends(row_sum_n_m_.size());
  std::vector<double> weights;
  const std::size_t rows = (all.size() + kLanes - 1) / kLanes * kLanes;
  for (auto* column : {&columns_.stiffness_n_m, &columns_.damping_n_s_m, &columns_.straight_m2}) column->resize(rows);
  for (std::size_t n = 0; n < all.size(); ++n) {
    const Stabilizer& s = all[n];
    columns_.stiffness_n_m[n] = s.stiffness_n_m;
    columns_.damping_n_s_m[n] = s.damping_n_s_m;
    columns_.straight_m2[n] = s.straight_m * s.straight_m;
    double reach = 0;
    for (const double weight : s.weights) reach += std::abs(weight);
    for (std::size_t k = 0; k < 4; ++k) {
      if (s.weights[k] == 0) continue;
      const auto i = static_cast<std::size_t>(s.vertices[k]);
      const auto item = static_cast<std::int32_t>(weights.size());
      points[n].push_back({s.vertices[k], item});
      ends[i].push_back({static_cast<VertexId>(n), item});
      weights.push_back(s.weights[k]);
      row_sum_n_m_[i] += s.stiffness_n_m * std::abs(s.weights[k]) * reach;
      row_sum_n_s_m_[i] += s.damping_n_s_m * std::abs(s.weights[k]) * reach;
    }
  }
  points_ = make_lane_table(points);
  ends_ = make_lane_table(ends);
  point_weight_ = points_.spread(weights);
  end_weight_ = ends_.spread(weights);
  for (LaneVectors* by_stabilizer : {&scaled_bow_, &impulse_})
    by_stabilizer->resize(static_cast<Eigen::Index>(all.size()));
}

StabilizerLanes::Strength StabilizerLanes::find_strength(std::span<const double> inverse_mass) const {
  Strength strength = Strength::kNone;
  for (std::size_t i = 0; i < row_sum_n_m_.size(); ++i) {
    const double opposed = inverse_mass[i] * row_sum(static_cast<VertexId>(i));
    if (!(opposed <= kWeak)) return Strength::kFull;
    if (opposed > 0) strength = Strength::kWeak;
  }
  return strength;
}

void StabilizerLanes::set_shares(const ImpulseShares& shares, std::span<const double> inverse_mass) {
  shares_ = shares;
  strength_ = find_strength(inverse_mass);
}

void StabilizerLanes::add_diagonal(const LaneVectors& x, LaneVectors& diagonal) {
  if (strength_ != Strength::kFull) return;
  parallel_blocks(scaled_bow_.rows(), [&](Eigen::Index begin, Eigen::Index end) {
    HWY_DYNAMIC_DISPATCH(ScaleBows)(points_, point_weight_, columns_, shares_, x, begin, end, scaled_bow_);
  });
  parallel_blocks(diagonal.rows(), [&](Eigen::Index begin, Eigen::Index end) {
    HWY_DYNAMIC_DISPATCH(AddDiagonal)(ends_, end_weight_, scaled_bow_, begin, end, diagonal);
  });
}

void StabilizerLanes::oppose(const LaneVectors& x, const LaneVectors& v) {
  answers_ = strength_ != Strength::kNone;
  if (!answers_) return;
  parallel_blocks(impulse_.rows(), [&](Eigen::Index begin, Eigen::Index end) {
    HWY_DYNAMIC_DISPATCH(Oppose)(points_, point_weight_, columns_, shares_, x, v, begin, end, impulse_);
  });
}

void StabilizerLanes::oppose_correction(const LaneVectors& x, const LaneVectors& v) {
  if (strength_ == Strength::kFull) {
    oppose(x, v);
  } else {
    answers_ = false;
  }
}

void StabilizerLanes::add_product(Eigen::Index begin, Eigen::Index end, LaneVectors& product) const {
  if (answers_) HWY_DYNAMIC_DISPATCH(AddProduct)(ends_, end_weight_, impulse_, begin, end, product);
}

double StabilizerLanes::row_sum(VertexId i) const {
  const auto row = static_cast<std::size_t>(i);
  if (row >= row_sum_n_m_.size()) return 0;  // there are no stabilisers
  return shares_.damping_s * row_sum_n_s_m_[row] + shares_.stiffness_s2 * row_sum_n_m_[row];
}

}  // namespace selvage::sim
#endif
