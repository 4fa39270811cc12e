#include "sim/springs/spring_lanes.h"

#include <limits>

#include "sim/base/parallel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sim/springs/spring_lanes.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "sim/base/lane_table-inl.h"

HWY_BEFORE_NAMESPACE();
namespace selvage::sim::HWY_NAMESPACE {

/// In the dynamics' own steps there is no stiffness in B, and then what it would need is not read.
template <bool kStiffness>
class Coefficients {
 public:
  explicit Coefficients(const ImpulseShares& shares)
      : damping_s_(hn::Set(Real(), shares.damping_s)), stiffness_s2_(hn::Set(Real(), shares.stiffness_s2)) {}

  HWY_INLINE Value operator()(const std::vector<double>& damping, const std::vector<double>& stiffness,
                              std::size_t entry) const {
    const Value part = hn::Mul(damping_s_, ReadEntries(damping, entry));
    if constexpr (kStiffness) return hn::Add(part, hn::Mul(stiffness_s2_, ReadEntries(stiffness, entry)));
    return part;
  }

 private:
  Value damping_s_, stiffness_s2_;
};

template <bool kStiffness>
void LookWith(const LaneTable& table, const LaneVectors& positions, const ImpulseShares& shares, Eigen::Index begin,
              Eigen::Index end, SpringEntries& entries, LaneVectors& force, LaneVectors& diagonal) {
  const Real d;
  const Axes x(positions);
  const Coefficients<kStiffness> coefficient(shares);
  const Value least_squared = hn::Set(d, std::numeric_limits<double>::min()), one = hn::Set(d, 1.0);
  for (Eigen::Index row = begin; row < end; row += VectorRows()) {
    const Vector x_i = ReadRows(x, row);
    Vector pull = ZeroRows(), own = ZeroRows();
    ForEachSlot(table, row, [&](std::size_t entry, auto read) HWY_ATTR SELVAGE_INLINE_LAMBDA {
      const Vector line = lanes::Minus<Real>(read(x), x_i);
      const Value squared = lanes::Dot<Real>(line, line);
      const auto apart = hn::Ge(squared, least_squared);
      const Value per_length = hn::IfThenElseZero(apart, hn::Div(one, hn::Sqrt(squared)));
      const Value pull_by_length =
          hn::Sub(ReadEntries(entries.pull_n_m, entry), hn::Mul(ReadEntries(entries.slack_pull_n, entry), per_length));
      pull = lanes::Plus<Real>(pull, lanes::Times<Real>(hn::IfThenElseZero(apart, pull_by_length), line));
      const Value along =
          hn::Mul(coefficient(entries.damping_n_s_m, entries.stiffness_n_m, entry), hn::Mul(per_length, per_length));
      hn::StoreU(along, d, entries.along.data() + entry);
      own = lanes::Plus<Real>(own, lanes::Times<Real>(along, lanes::Product<Real>(line, line)));
    });
    WriteRows(pull, force, row);
    WriteRows(own, diagonal, row);
  }
}

void Look(const LaneTable& table, const LaneVectors& x, const ImpulseShares& shares, Eigen::Index begin,
          Eigen::Index end, SpringEntries& entries, LaneVectors& force, LaneVectors& diagonal) {
  (shares.stiffness_s2 == 0 ? LookWith<false> : LookWith<true>)(table, x, shares, begin, end, entries, force, diagonal);
}

void MultiplyRows(const LaneTable& table, const SpringEntries& entries, const LaneVectors& positions,
                  const LaneVectors& velocities, Eigen::Index begin, Eigen::Index end, LaneVectors& product) {
  const Axes x(positions), v(velocities);
  for (Eigen::Index row = begin; row < end; row += VectorRows()) {
    const Vector x_i = ReadRows(x, row), v_i = ReadRows(v, row);
    Vector sum = ZeroRows();
    ForEachSlot(table, row, [&](std::size_t entry, auto read) HWY_ATTR SELVAGE_INLINE_LAMBDA {
      const Vector line = lanes::Minus<Real>(read(x), x_i), rate = lanes::Minus<Real>(v_i, read(v));
      const Value along = hn::Mul(ReadEntries(entries.along, entry), lanes::Dot<Real>(line, rate));
      sum = lanes::Plus<Real>(sum, lanes::Times<Real>(along, line));
    });
    WriteRows(sum, product, row);
  }
}

}  // namespace selvage::sim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace selvage::sim {
namespace {

/// What a vertex sees of another.
struct Pair {
  double stiffness_n_m = 0, rest_length_m = 0, damping_n_s_m = 0;
  double stabilizing_n_m = 0;
};

class PairCollector {
 public:
  PairCollector(const SpringSystem& springs, const StabilizerSystem* stabilizers)
      : neighbours_(static_cast<std::size_t>(springs.vertex_count())) {
    for (VertexId i = 0; i < springs.vertex_count(); ++i) {
      for (const SpringSystem::End& end : springs.ends_at(i)) {
        const Spring& spring = springs.springs()[end.spring];
        add(i, end.other) = {spring.stiffness_n_m, spring.rest_length_m, spring.damping_n_s_m, 0};
      }
      if (stabilizers == nullptr) continue;
      for (const StabilizerSystem::Neighbour& neighbour : stabilizers->neighbours_of(i)) {
        find_or_add(i, neighbour.vertex).stabilizing_n_m = -neighbour.coefficient_n_m;  // theirs is for x_i - x_j
      }
    }
  }

  [[nodiscard]] LaneTable table() const { return make_lane_table(neighbours_); }

  [[nodiscard]] SpringEntries entries(const LaneTable& table) const {
    SpringEntries entries;
    const auto spread = [&](auto value) {
      std::vector<double> values;
      values.reserve(pairs_.size());
      for (const Pair& pair : pairs_) values.push_back(value(pair));
      return table.spread(values);
    };
    entries.pull_n_m = spread([](const Pair& pair) { return pair.stiffness_n_m + pair.stabilizing_n_m; });
    entries.slack_pull_n = spread([](const Pair& pair) { return pair.stiffness_n_m * pair.rest_length_m; });
    entries.stiffness_n_m = spread([](const Pair& pair) { return pair.stiffness_n_m; });
    entries.damping_n_s_m = spread([](const Pair& pair) { return pair.damping_n_s_m; });
    entries.along.resize(table.item.size());
    return entries;
  }

 private:
  Pair& add(VertexId i, VertexId j) {
    neighbours_[static_cast<std::size_t>(i)].push_back({j, static_cast<std::int32_t>(pairs_.size())});
    return pairs_.emplace_back();
  }
  Pair& find_or_add(VertexId i, VertexId j) {
    for (const LaneNeighbour& known : neighbours_[static_cast<std::size_t>(i)]) {
      if (known.vertex == j) return pairs_[static_cast<std::size_t>(known.item)];
    }
    return add(i, j);
  }

  std::vector<std::vector<LaneNeighbour>> neighbours_;
  std::vector<Pair> pairs_;
};

}  // namespace

HWY_EXPORT(Look);
HWY_EXPORT(MultiplyRows);

SpringLanes::SpringLanes(const SpringSystem& springs, const StabilizerSystem* stabilizers) {
  const PairCollector collector(springs, stabilizers);
  table_ = collector.table();
  entries_ = collector.entries(table_);
  if (stabilizers != nullptr) stabilizers_ = StabilizerLanes(*stabilizers, springs.vertex_count());
  diagonal_.resize(springs.vertex_count());
}

void SpringLanes::set_shares(const ImpulseShares& shares, std::span<const double> inverse_mass) {
  shares_ = shares;
  stabilizers_.set_shares(shares, inverse_mass);
}

void SpringLanes::look(const LaneVectors& x, LaneVectors& force) {
  force.resize(x.rows());
  parallel_blocks(x.rows(), [&](Eigen::Index begin, Eigen::Index end) {
    HWY_DYNAMIC_DISPATCH(Look)(table_, x, shares_, begin, end, entries_, force, diagonal_);
  });
  stabilizers_.add_diagonal(x, diagonal_);
}

void SpringLanes::multiply_rows(const LaneVectors& x, const LaneVectors& v, Eigen::Index begin, Eigen::Index end,
                                LaneVectors& product) const {
  HWY_DYNAMIC_DISPATCH(MultiplyRows)(table_, entries_, x, v, begin, end, product);
  stabilizers_.add_product(begin, end, product);
}

void SpringLanes::multiply(const LaneVectors& x, const LaneVectors& v, LaneVectors& product) {
  product.resize(x.rows());
  begin_product(x, v);
  parallel_blocks(x.rows(), [&](Eigen::Index begin, Eigen::Index end) { multiply_rows(x, v, begin, end, product); });
}

double SpringLanes::row_sum(VertexId i) const {
  const auto block = static_cast<std::size_t>(i / kLanes), lane = static_cast<std::size_t>(i % kLanes);
  double along = 0;
  for (std::size_t slot = table_.begin[block]; slot < table_.begin[block + 1]; ++slot) {
    const std::size_t entry = kLanes * slot + lane;
    along += shares_.damping_s * entries_.damping_n_s_m[entry] + shares_.stiffness_s2 * entries_.stiffness_n_m[entry];
  }
  return 2 * along + stabilizers_.row_sum(i);
}

}  // namespace selvage::sim
#endif
