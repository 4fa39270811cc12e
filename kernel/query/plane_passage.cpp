#include "kernel/query/plane_passage.h"

#include <algorithm>
#include <bit>

#include "kernel/arithmetic/power_of_two.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernel/query/plane_passage.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "kernel/query/plane_passage-inl.h"

HWY_BEFORE_NAMESPACE();
namespace selvage::detail::HWY_NAMESPACE {

using Wide = hn::CappedTag<double, kMaxWideLanes>;
using Integer = hn::RebindToSigned<Wide>;
using Word = hn::RebindToUnsigned<Wide>;
using Value = hn::Vec<Wide>;
using Number = hn::Vec<Integer>;
using Choice = hn::Mask<Wide>;

/// The points of a pair at one instant, in query order.
struct WideInstant {
  Value3<Wide> point[4];
};
struct WidePointMotion {
  WideInstant t0, t1;
};

HWY_INLINE void Read(const LaneMotion& motion, const std::uint32_t* vertices, std::size_t k, WidePointMotion& x) {
  const Wide d;
  const double* rows = motion.rows.front().data();
  const Number places = hn::ShiftLeft<3>(
      hn::BitCast(Integer(), hn::PromoteTo(Word(), hn::LoadU(hn::Rebind<std::uint32_t, Wide>(), vertices))));
  const auto column = [&](int i) HWY_ATTR { return hn::GatherIndex(d, rows + i, places); };
  x.t0.point[k] = {column(0), column(1), column(2)};
  x.t1.point[k] = {column(3), column(4), column(5)};
}

/// Numbers in the order of doubles, -0 before +0.
HWY_INLINE Number OrderKey(Value value) {
  const Number bits = hn::BitCast(Integer(), value);
  const Number below = hn::BitCast(Integer(), hn::ShiftRight<1>(hn::BitCast(Word(), hn::BroadcastSignBit(bits))));
  return hn::Xor(bits, below);
}

/// The canonical order of the points in each lane (canonical_order.h), by sorting networks.
class Sorter {
 public:
  explicit HWY_INLINE Sorter(WidePointMotion& x) : x_(x) {}

  /// Of pairs with a common point any order will do: they touch, which is nothing that doubles place.
  HWY_INLINE void Sort(PairKind kind) {
    if (kind == PairKind::kVf) {
      SortPlaces(1, 2);
      SortPlaces(2, 3);
      SortPlaces(1, 2);
    } else {
      SortPlaces(0, 1);
      SortPlaces(2, 3);
      const Choice second_first = IsBefore(2, 0);
      Swap(second_first, 0, 2);
      Swap(second_first, 1, 3);
    }
  }

 private:
  HWY_INLINE Choice IsBefore(std::size_t i, std::size_t j) const {
    const Value a = x_.t0.point[i].x, b = x_.t0.point[j].x;
    if (hn::AllFalse(Wide(), hn::Eq(a, b))) return hn::Lt(a, b);  // nearly always
    return IsBeforeInAllBits(i, j);
  }
  HWY_INLINE Choice IsBeforeInAllBits(std::size_t i, std::size_t j) const {
    auto before = hn::Lt(hn::Zero(Integer()), hn::Zero(Integer()));
    const auto precede = [&](Value a, Value b) HWY_ATTR {
      const Number a_key = OrderKey(a), b_key = OrderKey(b);
      before = hn::Or(hn::Lt(a_key, b_key), hn::And(hn::Eq(a_key, b_key), before));
    };
    for (const WideInstant* x : {&x_.t1, &x_.t0}) {
      precede(x->point[i].z, x->point[j].z);
      precede(x->point[i].y, x->point[j].y);
      precede(x->point[i].x, x->point[j].x);
    }
    return hn::RebindMask(Wide(), before);
  }
  HWY_INLINE void SortPlaces(std::size_t i, std::size_t j) { Swap(IsBefore(j, i), i, j); }
  HWY_INLINE void Swap(Choice choice, std::size_t i, std::size_t j) {
    for (WideInstant* x : {&x_.t0, &x_.t1}) {
      const Value3<Wide> a = x->point[i], b = x->point[j];
      x->point[i] = Choose<Wide>(choice, b, a);
      x->point[j] = Choose<Wide>(choice, a, b);
    }
  }

  WidePointMotion& x_;
};

template <PairKind kKind>
HWY_INLINE LanePolygon<Wide> Differences(const WideInstant& x) {
  LanePolygon<Wide> polygon;
  const auto d = [&](std::size_t i, std::size_t j) HWY_ATTR { return Minus(x.point[i], x.point[j]); };
  if constexpr (kKind == PairKind::kVf) {
    for (std::size_t i = 0; i < 3; ++i) polygon.corner[i] = d(0, i + 1);
    polygon.edge_u = d(1, 2);
    polygon.edge_v = d(1, 3);
    polygon.edge_w = d(2, 3);
  } else {
    for (std::size_t i = 0; i < 4; ++i) polygon.corner[i] = d(i / 2, 2 + i % 2);
    polygon.edge_u = d(1, 0);
    polygon.edge_v = d(2, 3);
  }
  return polygon;
}

/// Scaled by a power of two, as make_pair_motion does; returns the powers.
template <PairKind kKind>
HWY_INLINE Value Scale(LanePolygonMotion<Wide>& motion) {
  constexpr std::size_t kCorners = kKind == PairKind::kEe ? 4 : 3;
  motion.extent = Absolute(motion.t0.corner[0]);
  for (LanePolygon<Wide>* polygon : {&motion.t0, &motion.t1}) {
    for (std::size_t i = 0; i < kCorners; ++i) motion.extent = Largest(motion.extent, Absolute(polygon->corner[i]));
  }
  const Value largest = hn::Max(hn::Max(motion.extent.x, motion.extent.y), motion.extent.z);
  // With the biased exponent b the largest is below 2^(b - 1022); 2045 - b is that of 2^(1022 - b).
  const auto biased = hn::ShiftRight<52>(hn::BitCast(Word(), largest));
  const Value factor = hn::BitCast(Wide(), hn::ShiftLeft<52>(hn::Sub(hn::Set(Word(), 2045), biased)));
  const auto scale = [&](Value3<Wide>& v) HWY_ATTR { v = Times<Wide>(factor, v); };
  for (LanePolygon<Wide>* polygon : {&motion.t0, &motion.t1}) {
    for (std::size_t i = 0; i < kCorners; ++i) scale(polygon->corner[i]);
    scale(polygon->edge_u);
    scale(polygon->edge_v);
    if constexpr (kKind == PairKind::kVf) scale(polygon->edge_w);
  }
  scale(motion.extent);
  return factor;
}

/// A bit a lane.
HWY_INLINE std::uint32_t BitsOf(Choice choice) {
  std::uint8_t bits[8] = {};
  hn::StoreMaskBits(Wide(), choice, bits);
  return bits[0];
}
template <class Body>
HWY_INLINE void ForEachLane(std::uint32_t bits, const Body& body) {
  for (; bits != 0; bits &= bits - 1) body(static_cast<std::size_t>(std::countr_zero(bits)));
}

/// What is found in some lanes, to be read one by one.
class ContactReader {
 public:
  HWY_INLINE ContactReader(const LanePassages<Wide>& found, const LaneTouch<Wide>& touch, Value factor) {
    const Wide d;
    hn::Store(touch.tick, d, tick_);
    hn::Store(touch.gap, d, gap_);
    hn::Store(found.intervals, d, intervals_);
    hn::Store(factor, d, factor_);
    for (std::size_t i = 0; i < 4; ++i) hn::Store(touch.weight[i], d, weight_[i]);
    hn::Store(touch.normal.x, d, normal_[0]);
    hn::Store(touch.normal.y, d, normal_[1]);
    hn::Store(touch.normal.z, d, normal_[2]);
  }

  [[nodiscard]] LaneContact At(std::size_t i, std::uint32_t pair, int exponent) const {
    PlanePassage passage;
    passage.passage = Passage::kContact;
    passage.intervals = static_cast<std::int32_t>(intervals_[i]);
    passage.tick = static_cast<Tick>(tick_[i]);
    passage.gap = gap_[i];
    for (std::size_t k = 0; k < 4; ++k) passage.weights[k] = weight_[k][i];
    passage.normal = {normal_[0][i], normal_[1][i], normal_[2][i]};
    return {pair, passage, exponent + 1 - exponent_of(factor_[i])};
  }

 private:
  HWY_ALIGN double tick_[kMaxWideLanes], gap_[kMaxWideLanes], intervals_[kMaxWideLanes], factor_[kMaxWideLanes],
      weight_[4][kMaxWideLanes], normal_[3][kMaxWideLanes];
};

template <PairKind kKind>
class ListPassage {
 public:
  ListPassage(const LaneMotion& motion, double tolerance, std::vector<LaneContact>& contacts)
      : motion_(motion), tolerance_(tolerance), contacts_(contacts) {}

  void Run(const LanePairs& pairs, PairNumbers& numbers) {
    PairNumbers split, unclear, still_unclear;
    LookAt<true>(pairs, numbers, split, unclear);
    LookAt<false>(pairs, split, split, still_unclear);
    const auto *first = unclear.place.data(), *second = still_unclear.place.data();
    std::merge(first, first + unclear.count, second, second + still_unclear.count, numbers.place.data());
    numbers.count = unclear.count + still_unclear.count;
  }

 private:
  /// At the whole step, or at parts of it.
  template <bool kWhole>
  HWY_INLINE void LookAt(const LanePairs& all, const PairNumbers& numbers, PairNumbers& split, PairNumbers& unclear) {
    const LanePairs pairs(all, numbers);
    for (std::size_t i = 0; i < numbers.count; i += hn::Lanes(Wide())) {
      WidePointMotion x;
      for (std::size_t k = 0; k < 4; ++k) Read(motion_, pairs.vertices(k) + i, k, x);
      Sorter(x).Sort(kKind);
      LanePolygonMotion<Wide> polygons = {Differences<kKind>(x.t0), Differences<kKind>(x.t1), {}};
      const Value factor = Scale<kKind>(polygons);
      PlanePassages<kKind, Wide> passages(polygons);
      LaneTouch<Wide> touch;
      LanePassages<Wide> found = kWhole ? passages.Whole(touch) : passages.Parts(touch);
      if (tolerance_ > 0) {
        const Value scaled = hn::Add(hn::Mul(factor, hn::Set(Wide(), tolerance_)), hn::Set(Wide(), kUnderflowError));
        found.separated = hn::And(found.separated, passages.EndsBeyond(scaled));
      }
      const std::uint32_t* const of_lane = numbers.place.data() + i;
      const std::uint32_t lanes = BitsOf(hn::FirstN(Wide(), numbers.count - i));
      const std::uint32_t contact = lanes & BitsOf(found.contact), open = lanes & BitsOf(found.open);
      if (contact != 0) {
        const ContactReader reader(found, touch, factor);
        ForEachLane(contact, [&](std::size_t k) { contacts_.push_back(reader.At(k, of_lane[k], motion_.exponent)); });
      }
      if constexpr (kWhole) ForEachLane(open, [&](std::size_t k) { split.add(of_lane[k]); });
      ForEachLane(lanes & ~(contact | open | BitsOf(found.separated)), [&](std::size_t k) { unclear.add(of_lane[k]); });
    }
  }

  const LaneMotion& motion_;
  const double tolerance_;
  std::vector<LaneContact>& contacts_;
};

void PassList(const LaneMotion& motion, const LanePairs& pairs, double tolerance, PairNumbers& numbers,
              std::vector<LaneContact>& contacts) {
  if (pairs.kind() == PairKind::kVf) {
    ListPassage<PairKind::kVf>(motion, tolerance, contacts).Run(pairs, numbers);
  } else {
    ListPassage<PairKind::kEe>(motion, tolerance, contacts).Run(pairs, numbers);
  }
}

using One = hn::CappedTag<double, 1>;

HWY_INLINE Value3<One> InOneLane(const Double3& v) {
  const One d;
  return {hn::Set(d, v.x), hn::Set(d, v.y), hn::Set(d, v.z)};
}
HWY_INLINE LanePolygon<One> InOneLane(const DifferencePolygon<double>& polygon) {
  return {{InOneLane(polygon.corner[0]), InOneLane(polygon.corner[1]), InOneLane(polygon.corner[2]),
           InOneLane(polygon.corner[3])},
          InOneLane(polygon.edge_u),
          InOneLane(polygon.edge_v),
          InOneLane(polygon.edge_w)};
}

template <PairKind kKind>
PlanePassage PassSingle(const PairMotion<double>& motion) {
  const LanePolygonMotion<One> polygons = {InOneLane(motion.t0), InOneLane(motion.t1), InOneLane(motion.extent)};
  PlanePassages<kKind, One> passages(polygons);
  LaneTouch<One> touch;
  LanePassages<One> found = passages.Whole(touch);
  if (hn::AllTrue(One(), found.open)) found = passages.Parts(touch);
  PlanePassage result;
  const auto value = [](hn::Vec<One> v) HWY_ATTR { return hn::GetLane(v); };
  result.intervals = static_cast<std::int32_t>(value(found.intervals));
  if (hn::AllTrue(One(), found.separated)) result.passage = Passage::kSeparated;
  if (!hn::AllTrue(One(), found.contact)) return result;
  result.passage = Passage::kContact;
  result.tick = static_cast<Tick>(value(touch.tick));
  result.gap = value(touch.gap);
  for (std::size_t i = 0; i < 4; ++i) result.weights[i] = value(touch.weight[i]);
  result.normal = {value(touch.normal.x), value(touch.normal.y), value(touch.normal.z)};
  return result;
}
PlanePassage PassOne(const PairMotion<double>& motion) {
  return motion.kind == PairKind::kVf ? PassSingle<PairKind::kVf>(motion) : PassSingle<PairKind::kEe>(motion);
}

}  // namespace selvage::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace selvage::detail {

HWY_EXPORT(PassList);

PlanePassage plane_passage(const PairMotion<double>& motion) { return HWY_STATIC_DISPATCH(PassOne)(motion); }

void pass_in_lanes(const LaneMotion& motion, const LanePairs& pairs, double tolerance, PairNumbers& numbers,
                   std::vector<LaneContact>& contacts) {
  const double scaled = times_power_upper(tolerance, -motion.exponent);
  HWY_DYNAMIC_DISPATCH(PassList)(motion, pairs, scaled, numbers, contacts);
}

}  // namespace selvage::detail
#endif
