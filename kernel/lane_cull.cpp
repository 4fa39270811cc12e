#include "kernel/lane_cull.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "kernel/power_of_two.h"
#include "kernel/rounding.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernel/lane_cull.cpp"
#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace selvage::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Real = hn::CappedTag<double, kCullLanes>;
using Integer = hn::RebindToSigned<Real>;
using Word = hn::RebindToUnsigned<Real>;
using Value = hn::Vec<Real>;
using Number = hn::Vec<Integer>;
using Choice = hn::Mask<Real>;

// Only operations that round alike on every target, and nothing fused, so that all targets decide alike (K7).

struct Value3 {
  Value x, y, z;
};

HWY_INLINE Value3 Plus(const Value3& a, const Value3& b) {
  return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z)};
}
HWY_INLINE Value3 Minus(const Value3& a, const Value3& b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
HWY_INLINE Value3 Times(Value s, const Value3& a) { return {hn::Mul(s, a.x), hn::Mul(s, a.y), hn::Mul(s, a.z)}; }
HWY_INLINE Value Dot(const Value3& a, const Value3& b) {
  return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}
HWY_INLINE Value3 Cross(const Value3& a, const Value3& b) {
  return {hn::Sub(hn::Mul(a.y, b.z), hn::Mul(a.z, b.y)), hn::Sub(hn::Mul(a.z, b.x), hn::Mul(a.x, b.z)),
          hn::Sub(hn::Mul(a.x, b.y), hn::Mul(a.y, b.x))};
}
HWY_INLINE Value3 Choose(Choice first, const Value3& a, const Value3& b) {
  return {hn::IfThenElse(first, a.x, b.x), hn::IfThenElse(first, a.y, b.y), hn::IfThenElse(first, a.z, b.z)};
}

/// The points of a pair at one instant, in query order.
struct Instant {
  Value3 point[4];
};
/// A pair over a part of the step.
struct Motion {
  Instant begin, end;
};

/// A list of pairs as the places of their vertices' rows, and the rows where they are needed.
template <PairKind kKind>
class Reader {
 public:
  /// Looks up all vertices first: what memory delays here delays no arithmetic.
  Reader(const LaneMotion& motion, const void* pairs, std::size_t count)
      : rows_(motion.rows.front().data()), count_(count) {
    const auto* words = (kKind == PairKind::kEe ? motion.edge_words : motion.face_words).data();
    const auto* list = static_cast<const std::int64_t*>(pairs);
    const Integer d;
    std::array<std::int64_t, kCullLanes> tail = {};
    for (std::size_t row = 0; row < count; row += hn::Lanes(d)) {
      const Number pair = hn::LoadU(d, row + hn::Lanes(d) <= count ? list + row : Tail(list, row, count, tail));
      const Number second = High(pair);
      const auto word_at = [&](Number place) HWY_ATTR { return hn::BitCast(d, hn::GatherIndex(Word(), words, place)); };
      if constexpr (kKind == PairKind::kEe) {
        PutBoth(word_at(Low(pair)), 0, row);
        PutBoth(word_at(second), 2, row);
      } else {
        const Number place = hn::Add(second, second);
        Put(Low(pair), 0, row);
        PutBoth(word_at(place), 1, row);
        Put(word_at(hn::Add(place, hn::Set(d, 1))), 3, row);
      }
    }
  }

  [[nodiscard]] std::size_t count() const { return count_; }

  /// The pairs from `row` on; what stands beyond the end is some pair or other. Candidates are sorted by their first
  /// feature, which therefore is mostly the same in all lanes.
  HWY_INLINE void Next(std::size_t row, Motion& motion) const {
    Prefetch(row + kAhead);
    HWY_UNROLL(4)
    for (std::size_t k = 0; k < 4; ++k) {
      const Number at = hn::LoadU(Integer(), &at_[k][row]);
      const std::int64_t leader = at_[k][row];
      const bool may_share = k < (kKind == PairKind::kEe ? 2 : 1);
      if (may_share && hn::AllTrue(Integer(), hn::Eq(at, hn::Set(Integer(), leader)))) {
        Fill(rows_ + leader, k, motion);
      } else {
        Gather(at, k, motion);
      }
    }
  }
  HWY_INLINE void At(Number places, Motion& motion) const {
    HWY_UNROLL(4)
    for (std::size_t k = 0; k < 4; ++k) Gather(hn::GatherIndex(Integer(), at_[k].data(), places), k, motion);
  }

 private:
  static_assert(std::endian::native == std::endian::little, "the first feature of a candidate is its low half");
  static_assert(sizeof(VfCandidate) == 8 && sizeof(EeCandidate) == 8);
  /// Pairs between the one that is looked at and the one whose rows are fetched: some 150 ns.
  static constexpr std::size_t kAhead = 16;

  static HWY_INLINE Number Low(Number word) { return hn::And(word, hn::Set(Integer(), 0xffffffff)); }
  static HWY_INLINE Number High(Number word) {
    return hn::BitCast(Integer(), hn::ShiftRight<32>(hn::BitCast(Word(), word)));
  }
  /// The last pairs with room for a whole vector behind them.
  static const std::int64_t* Tail(const std::int64_t* list, std::size_t row, std::size_t count,
                                  std::array<std::int64_t, kCullLanes>& tail) {
    std::memcpy(tail.data(), list + row, (count - row) * sizeof(std::int64_t));
    return tail.data();
  }
  HWY_INLINE void Put(Number vertex, std::size_t k, std::size_t row) {
    hn::StoreU(hn::ShiftLeft<3>(vertex), Integer(), &at_[k][row]);
  }
  HWY_INLINE void PutBoth(Number word, std::size_t k, std::size_t row) {
    Put(Low(word), k, row);
    Put(High(word), k + 1, row);
  }

  HWY_INLINE void Prefetch(std::size_t row) const {
    if (row + hn::Lanes(Integer()) > count_) return;
    for (std::size_t k = kKind == PairKind::kEe ? 2 : 1; k < 4; ++k) {
      for (std::size_t i = 0; i < hn::Lanes(Integer()); ++i) hwy::Prefetch(rows_ + at_[k][row + i]);
    }
  }
  HWY_INLINE void Fill(const double* row, std::size_t k, Motion& motion) const {
    const Real d;
    motion.begin.point[k] = {hn::Set(d, row[0]), hn::Set(d, row[1]), hn::Set(d, row[2])};
    motion.end.point[k] = {hn::Set(d, row[3]), hn::Set(d, row[4]), hn::Set(d, row[5])};
  }
  HWY_INLINE void Gather(Number at, std::size_t k, Motion& motion) const {
    const auto column = [&](int i) HWY_ATTR { return hn::GatherIndex(Real(), rows_ + i, at); };
    motion.begin.point[k] = {column(0), column(1), column(2)};
    motion.end.point[k] = {column(3), column(4), column(5)};
  }

  const double* rows_;
  const std::size_t count_;
  std::array<std::array<std::int64_t, kPairBlock + kCullLanes>, 4> at_;
};

/// Looks for a direction that separates all pairs' features; bounds: kLaneError.
template <PairKind kKind>
class Look {
 public:
  /// `tolerance` in the scale of the rows, rounded up.
  explicit Look(double tolerance) : tolerance_(tolerance * kLaneToleranceRounding) {}

  /// The normal at half time, either way, then the direction from mean to mean.
  HWY_INLINE Choice IsApartAtOnce(const Motion& motion) const {
    const Choice is_last = hn::FirstN(Real(), kCullLanes);
    return hn::Or(AlongNormal(motion, is_last), Along(Project(motion, MeanOf(motion)), is_last));
  }

  /// The normal, then Gilbert's algorithm: from the difference of the means towards the least difference along it.
  /// `is_last`: the part ends at t = 1.
  HWY_INLINE Choice IsApart(const Motion& motion, Choice is_last) const {
    const Real d;
    Choice apart = AlongNormal(motion, is_last);
    Value3 point = MeanOf(motion);
    for (int i = 1;; ++i) {
      const Projection w = Project(motion, point);
      apart = hn::Or(apart, Along(w, is_last));
      if (i == kDirections || hn::AllTrue(d, apart)) return apart;
      const Value3 least = LeastDifference(motion, w);
      const Value3 toward = Minus(least, point);
      const Value fraction = hn::Div(hn::Neg(Dot(point, toward)), Dot(toward, toward));
      point = Plus(point, Times(hn::Min(fraction, hn::Set(d, 1.0)), toward));
    }
  }

 private:
  static constexpr int kDirections = 4;

  struct Projection {
    Value3 n;
    Value begin[4], end[4];
  };

  static HWY_INLINE Projection Project(const Motion& motion, const Value3& n) {
    Projection w;
    w.n = n;
    HWY_UNROLL(4)
    for (std::size_t k = 0; k < 4; ++k) {
      w.begin[k] = Dot(n, motion.begin.point[k]);
      w.end[k] = Dot(n, motion.end.point[k]);
    }
    return w;
  }

  static HWY_INLINE Value3 EdgeU(const Instant& x) {
    return kKind == PairKind::kEe ? Minus(x.point[1], x.point[0]) : Minus(x.point[2], x.point[1]);
  }
  static HWY_INLINE Value3 EdgeV(const Instant& x) {
    return kKind == PairKind::kEe ? Minus(x.point[3], x.point[2]) : Minus(x.point[3], x.point[1]);
  }
  static HWY_INLINE Value3 MeanOf(const Motion& motion) {
    const Real d;
    const auto sum = [&](std::size_t k) HWY_ATTR { return Plus(motion.begin.point[k], motion.end.point[k]); };
    if constexpr (kKind == PairKind::kEe) {
      return Times(hn::Set(d, 0.25), Minus(Plus(sum(0), sum(1)), Plus(sum(2), sum(3))));
    } else {
      const Value3 corners = Times(hn::Set(d, 1.0 / 6), Plus(Plus(sum(1), sum(2)), sum(3)));
      return Minus(Times(hn::Set(d, 0.5), sum(0)), corners);
    }
  }

  /// Of n . first - n . second at one end.
  static HWY_INLINE Value Lowest(const Value* w) {
    return kKind == PairKind::kEe ? hn::Sub(hn::Min(w[0], w[1]), hn::Max(w[2], w[3]))
                                  : hn::Sub(w[0], hn::Max(w[1], hn::Max(w[2], w[3])));
  }
  static HWY_INLINE Value Highest(const Value* w) {
    return kKind == PairKind::kEe ? hn::Sub(hn::Max(w[0], w[1]), hn::Min(w[2], w[3]))
                                  : hn::Sub(w[0], hn::Min(w[1], hn::Min(w[2], w[3])));
  }

  struct Bounds {
    Value begin, end;
  };
  HWY_INLINE Bounds BoundsOf(const Value3& n, Choice is_last) const {
    const Real d;
    const Value size = hn::Add(hn::Add(hn::Abs(n.x), hn::Abs(n.y)), hn::Abs(n.z));
    const Value factor = hn::Set(d, kLaneError), last_factor = hn::Set(d, kLaneError + tolerance_);
    const Value slack = hn::Set(d, kLaneSlack);
    return {hn::Add(hn::Mul(factor, size), slack),
            hn::Add(hn::Mul(hn::IfThenElse(is_last, last_factor, factor), size), slack)};
  }

  HWY_INLINE Choice Along(const Projection& w, Choice is_last) const {
    const Bounds bound = BoundsOf(w.n, is_last);
    return hn::And(hn::Gt(Lowest(w.begin), bound.begin), hn::Gt(Lowest(w.end), bound.end));
  }

  HWY_INLINE Choice AlongNormal(const Motion& motion, Choice is_last) const {
    const Value3 n = Cross(Plus(EdgeU(motion.begin), EdgeU(motion.end)), Plus(EdgeV(motion.begin), EdgeV(motion.end)));
    const Projection w = Project(motion, n);
    const Bounds bound = BoundsOf(n, is_last);
    return hn::Or(hn::And(hn::Gt(Lowest(w.begin), bound.begin), hn::Gt(Lowest(w.end), bound.end)),
                  hn::And(hn::Gt(hn::Neg(Highest(w.begin)), bound.begin), hn::Gt(hn::Neg(Highest(w.end)), bound.end)));
  }

  static HWY_INLINE Value3 LeastAt(const Instant& x, const Value* w) {
    if constexpr (kKind == PairKind::kEe) {
      return Minus(Choose(hn::Lt(w[1], w[0]), x.point[1], x.point[0]),
                   Choose(hn::Gt(w[3], w[2]), x.point[3], x.point[2]));
    } else {
      const Value3 larger = Choose(hn::Gt(w[2], w[1]), x.point[2], x.point[1]);
      return Minus(x.point[0], Choose(hn::Gt(w[3], hn::Max(w[1], w[2])), x.point[3], larger));
    }
  }
  static HWY_INLINE Value3 LeastDifference(const Motion& motion, const Projection& w) {
    return Choose(hn::Lt(Lowest(w.end), Lowest(w.begin)), LeastAt(motion.end, w.end), LeastAt(motion.begin, w.begin));
  }

  const double tolerance_;
};

/// Leaves the number'th of 2^level equal parts of the motion.
HWY_INLINE void Cut(Number number, int level, Motion& motion) {
  const Real d;
  const Value width = hn::Set(d, power_of_two(-level)), one = hn::Set(d, 1.0);
  const Value begin = hn::Mul(width, hn::ConvertTo(d, number)), end = hn::Add(begin, width);
  const Value before = hn::Sub(one, begin), before_end = hn::Sub(one, end);
  HWY_UNROLL(4)
  for (std::size_t k = 0; k < 4; ++k) {
    const Value3 x_t0 = motion.begin.point[k], x_t1 = motion.end.point[k];
    motion.begin.point[k] = Plus(Times(before, x_t0), Times(begin, x_t1));
    motion.end.point[k] = Plus(Times(before_end, x_t0), Times(end, x_t1));
  }
}

/// Halvings of the step. On the cloth-ball frame 13 % of the pairs pass the first look, 6 % the directions for the
/// whole step, then 4.4, 3.3 and 2.7 %; 1.7 % touch. One level more or less costs what it spares (within 2 ns a pair).
constexpr int kLevels = 3;

/// Parts of pairs, all of one level.
struct PartList {
  std::array<std::int64_t, (kPairBlock << kLevels) + kCullLanes> pair, number;
  std::size_t count = 0;

  PartList() {}  // the lists are written before they are read

  void add(std::int64_t of_pair, std::int64_t at) {
    pair[count] = of_pair;
    number[count++] = at;
  }
};

template <PairKind kKind>
std::size_t LookAtAll(const Reader<kKind>& reader, const Look<kKind>& look, PairNumbers& left) {
  std::uint64_t* out = left.data();
  for (std::size_t row = 0; row < reader.count(); row += hn::Lanes(Real())) {
    Motion motion;
    reader.Next(row, motion);
    const Choice apart = look.IsApartAtOnce(motion);
    const Choice open = hn::AndNot(apart, hn::FirstN(Real(), reader.count() - row));
    out += hn::CompressStore(hn::Iota(Word(), row), hn::RebindMask(Word(), open), Word(), out);
  }
  return static_cast<std::size_t>(out - left.data());
}

/// Writes the places in `parts` of those without a direction.
template <PairKind kKind>
std::size_t LookAtParts(const Reader<kKind>& reader, const Look<kKind>& look, PartList& parts, int level,
                        std::uint64_t* open) {
  std::fill_n(parts.pair.begin() + static_cast<std::ptrdiff_t>(parts.count), kCullLanes, 0);
  std::fill_n(parts.number.begin() + static_cast<std::ptrdiff_t>(parts.count), kCullLanes, 0);
  const Integer d;
  std::uint64_t* out = open;
  for (std::size_t row = 0; row < parts.count; row += hn::Lanes(d)) {
    const Number number = hn::LoadU(d, &parts.number[row]);
    Motion motion;
    reader.At(hn::LoadU(d, &parts.pair[row]), motion);
    if (level > 0) Cut(number, level, motion);
    const Choice is_last = hn::RebindMask(Real(), hn::Eq(number, hn::Set(d, (1 << level) - 1)));
    const Choice apart = look.IsApart(motion, is_last);
    const Choice still = hn::AndNot(apart, hn::FirstN(Real(), parts.count - row));
    out += hn::CompressStore(hn::Iota(Word(), row), hn::RebindMask(Word(), still), Word(), out);
  }
  return static_cast<std::size_t>(out - open);
}

/// Parts without a direction are halved; pairs that have one at the last level are left.
template <PairKind kKind>
std::size_t Cull(const LaneMotion& motion, const void* pairs, std::size_t pair_count, double tolerance,
                 PairNumbers& left) {
  const Reader<kKind> reader(motion, pairs, pair_count);
  const Look<kKind> look(tolerance);
  const std::size_t count = LookAtAll(reader, look, left);
  PartList lists[2];
  for (const std::uint64_t pair : std::span(left).first(count)) lists[0].add(static_cast<std::int64_t>(pair), 0);
  std::array<std::uint64_t, (kPairBlock << kLevels) + kCullLanes> open;
  for (int level = 0; level <= kLevels; ++level) {
    PartList &parts = lists[level % 2], &halves = lists[(level + 1) % 2];
    const std::size_t open_count = LookAtParts(reader, look, parts, level, open.data());
    halves.count = 0;
    for (const std::uint64_t place : std::span(open).first(open_count)) {
      const std::int64_t pair = parts.pair[place], number = parts.number[place];
      halves.add(pair, 2 * number);
      if (level < kLevels) halves.add(pair, 2 * number + 1);
    }
  }
  const PartList& last = lists[(kLevels + 1) % 2];
  std::size_t left_count = 0;
  for (std::size_t i = 0; i < last.count; ++i) {
    const auto pair = static_cast<std::uint64_t>(last.pair[i]);
    if (left_count == 0 || left[left_count - 1] != pair) left[left_count++] = pair;
  }
  return left_count;
}

std::size_t CullVf(const LaneMotion& motion, std::span<const VfCandidate> pairs, double tolerance, PairNumbers& left) {
  return Cull<PairKind::kVf>(motion, pairs.data(), pairs.size(), tolerance, left);
}
std::size_t CullEe(const LaneMotion& motion, std::span<const EeCandidate> pairs, double tolerance, PairNumbers& left) {
  return Cull<PairKind::kEe>(motion, pairs.data(), pairs.size(), tolerance, left);
}

}  // namespace selvage::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace selvage::detail {

HWY_EXPORT(CullVf);
HWY_EXPORT(CullEe);

namespace {

std::uint64_t word_of(VertexId low, VertexId high) {
  return static_cast<std::uint64_t>(low) | static_cast<std::uint64_t>(high) << 32;
}

}  // namespace

LaneMotion::LaneMotion(const Mesh& mesh, const PositionsRef& V_t0, const PositionsRef& V_t1)
    : rows(static_cast<std::size_t>(V_t0.rows())) {
  double largest = 0;
  for (const PositionsRef* V : {&V_t0, &V_t1}) {
    for (Eigen::Index v = 0; v < V->rows(); ++v) {
      for (Eigen::Index axis = 0; axis < 3; ++axis) {
        const double size = std::fabs((*V)(v, axis));
        is_valid_ = is_valid_ && size <= kMaxCoordinate;  // false for NaN
        largest = std::max(largest, size);
      }
    }
  }
  if (!is_valid_) return;
  exponent = largest > 0 ? exponent_of(largest) : 0;
  for (std::size_t v = 0; v < rows.size(); ++v) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto i = static_cast<Eigen::Index>(v), k = static_cast<Eigen::Index>(axis);
      rows[v][axis] = times_power(V_t0(i, k), -exponent);
      rows[v][axis + 3] = times_power(V_t1(i, k), -exponent);
    }
  }
  for (const auto& edge : mesh.edges) edge_words.push_back(word_of(edge[0], edge[1]));
  for (const auto& face : mesh.faces) {
    face_words.push_back(word_of(face[0], face[1]));
    face_words.push_back(word_of(face[2], 0));
  }
}

std::size_t cull_in_lanes(const LaneMotion& motion, std::span<const VfCandidate> pairs, double tolerance,
                          PairNumbers& left) {
  const double scaled = times_power_upper(tolerance, -motion.exponent);
  return HWY_DYNAMIC_DISPATCH(CullVf)(motion, pairs, scaled, left);
}
std::size_t cull_in_lanes(const LaneMotion& motion, std::span<const EeCandidate> pairs, double tolerance,
                          PairNumbers& left) {
  const double scaled = times_power_upper(tolerance, -motion.exponent);
  return HWY_DYNAMIC_DISPATCH(CullEe)(motion, pairs, scaled, left);
}

}  // namespace selvage::detail
#endif
