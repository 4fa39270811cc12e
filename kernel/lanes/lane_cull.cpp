#include "kernel/lanes/lane_cull.h"

#include "kernel/arithmetic/power_of_two.h"
#include "kernel/arithmetic/rounding.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernel/lanes/lane_cull.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "kernel/lanes/lane_vector-inl.h"

HWY_BEFORE_NAMESPACE();
namespace selvage::detail::HWY_NAMESPACE {

using Near = hn::CappedTag<float, kMaxLanes>;
using Place = hn::RebindToUnsigned<Near>;
using Value = hn::Vec<Near>;
using Choice = hn::Mask<Near>;
using Vector = Value3<Near>;

/// The points of a pair at one instant, in query order.
struct Instant {
  Vector point[4];
};
struct PointMotion {
  Instant t0, t1;
};

#if HWY_TARGET != HWY_SCALAR
/// A block of four neighbouring values from the row of every fourth vertex.
template <class D>
HWY_INLINE hn::Vec<D> RowBlocks(D d, const float* column, const std::uint32_t* vertices) {
  if constexpr (hn::MaxLanes(D()) == 4) {
    return hn::Load(d, column + 8 * std::size_t{*vertices});
  } else {
    const hn::Half<D> half;
    const auto low = RowBlocks(half, column, vertices);
    return hn::Combine(d, RowBlocks(half, column, vertices + hn::MaxLanes(D()) / 2), low);
  }
}

/// Three columns of the vertices' rows. Whole blocks are read and then put in order, which takes a third of the time
/// of gathering single values.
HWY_INLINE Vector ReadColumns(const float* column, const std::uint32_t* vertices) {
  const Near d;
  const hn::Repartition<std::uint64_t, Near> wide;
  const auto first = RowBlocks(d, column, vertices), second = RowBlocks(d, column, vertices + 1);
  const auto third = RowBlocks(d, column, vertices + 2), fourth = RowBlocks(d, column, vertices + 3);
  const auto xy_low = hn::BitCast(wide, hn::InterleaveLower(d, first, second));
  const auto xy_high = hn::BitCast(wide, hn::InterleaveLower(d, third, fourth));
  const auto z_low = hn::BitCast(wide, hn::InterleaveUpper(d, first, second));
  const auto z_high = hn::BitCast(wide, hn::InterleaveUpper(d, third, fourth));
  return {hn::BitCast(d, hn::InterleaveLower(wide, xy_low, xy_high)),
          hn::BitCast(d, hn::InterleaveUpper(wide, xy_low, xy_high)),
          hn::BitCast(d, hn::InterleaveLower(wide, z_low, z_high))};
}
#else
HWY_INLINE Vector ReadColumns(const float* column, const std::uint32_t* vertices) {
  const float* row = column + 8 * std::size_t{*vertices};
  return {hn::Set(Near(), row[0]), hn::Set(Near(), row[1]), hn::Set(Near(), row[2])};
}
#endif

/// Looks for a direction that separates the features of all pairs over the step; bounds: kNearError.
template <PairKind kKind>
class Look {
 public:
  /// `tolerance` in the scale of the rows, rounded up.
  Look(const LaneMotion& motion, float tolerance)
      : rows_(motion.near_rows.front().data()), last_factor_(kNearError + tolerance) {}

  /// Tries the normal at half time, either way, then the direction from mean to mean.
  void LookAtAll(const LanePairs& pairs, PairNumbers& left) const {
    left.count = 0;
    for (std::size_t i = 0; i < pairs.count(); i += hn::Lanes(Near())) {
      PointMotion x;
      HWY_UNROLL(4)
      for (std::size_t k = 0; k < 4; ++k) {
        const bool may_share = k < (kKind == PairKind::kEe ? 2 : 1);
        may_share&& AllAlike(pairs.vertices(k) + i) ? Fill(pairs.vertices(k)[i], k, x)
                                                    : Read(pairs.vertices(k) + i, k, x);
      }
      Choice apart = IsAcross(x);
      apart = hn::Or(apart, IsAbove(Project(x, MeanOf(x))));
      Keep(apart, pairs.count() - i, hn::Iota(Place(), static_cast<std::uint32_t>(i)), left);
    }
  }

  /// Gilbert's algorithm: on from the direction from mean to mean.
  void LookCloser(const LanePairs& pairs, PairNumbers& left) const {
    const std::size_t count = left.count;
    left.count = 0;
    for (std::size_t i = 0; i < count; i += hn::Lanes(Near())) {
      PointMotion x;
      HWY_UNROLL(4)
      for (std::size_t k = 0; k < 4; ++k) Read(pairs.vertices(k) + i, k, x);
      Vector point = MeanOf(x);
      Projection w = Project(x, point);
      Choice apart = IsAbove(w);
      for (int step = 0; step < kSteps; ++step) {
        const Vector toward = Minus(LeastDifference(x, w), point);
        const Value fraction = hn::Div(hn::Neg(Dot(point, toward)), Dot(toward, toward));
        point = Plus(point, Times<Near>(hn::Min(fraction, hn::Set(Near(), 1.0F)), toward));
        w = Project(x, point);
        apart = hn::Or(apart, IsAbove(w));
      }
      Keep(apart, count - i, hn::LoadU(Place(), left.place.data() + i), left);
    }
  }

 private:
  /// On the cloth-ball frame the normal and the means leave 13 % of the pairs, these steps 6 %; 1.7 % touch.
  static constexpr int kSteps = 3;

  struct Projection {
    Vector n;
    Value t0[4], t1[4];
  };
  static HWY_INLINE Projection Project(const PointMotion& x, const Vector& n) {
    Projection w;
    w.n = n;
    HWY_UNROLL(4)
    for (std::size_t k = 0; k < 4; ++k) {
      w.t0[k] = Dot(n, x.t0.point[k]);
      w.t1[k] = Dot(n, x.t1.point[k]);
    }
    return w;
  }

  static HWY_INLINE Vector EdgeU(const Instant& x) {
    return kKind == PairKind::kEe ? Minus(x.point[1], x.point[0]) : Minus(x.point[2], x.point[1]);
  }
  static HWY_INLINE Vector EdgeV(const Instant& x) {
    return kKind == PairKind::kEe ? Minus(x.point[3], x.point[2]) : Minus(x.point[3], x.point[1]);
  }
  static HWY_INLINE Vector MeanOf(const PointMotion& x) {
    const Near d;
    const auto sum = [&](std::size_t k) HWY_ATTR { return Plus(x.t0.point[k], x.t1.point[k]); };
    if constexpr (kKind == PairKind::kEe) {
      return Times<Near>(hn::Set(d, 0.25F), Minus(Plus(sum(0), sum(1)), Plus(sum(2), sum(3))));
    } else {
      const Vector corners = Times<Near>(hn::Set(d, 1.0F / 6), Plus(Plus(sum(1), sum(2)), sum(3)));
      return Minus(Times<Near>(hn::Set(d, 0.5F), sum(0)), corners);
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
    Value t0, t1;
  };
  HWY_INLINE Bounds BoundsOf(const Vector& n) const {
    const Near d;
    const Value size = SumOf(Absolute(n)), slack = hn::Set(d, kNearSlack);
    return {hn::Add(hn::Mul(hn::Set(d, kNearError), size), slack),
            hn::Add(hn::Mul(hn::Set(d, last_factor_), size), slack)};
  }
  HWY_INLINE Choice IsAbove(const Projection& w) const {
    const Bounds bounds = BoundsOf(w.n);
    return hn::And(hn::Gt(Lowest(w.t0), bounds.t0), hn::Gt(Lowest(w.t1), bounds.t1));
  }
  /// Along the normal at half time, either way.
  HWY_INLINE Choice IsAcross(const PointMotion& x) const {
    const Projection w = Project(x, Cross(Plus(EdgeU(x.t0), EdgeU(x.t1)), Plus(EdgeV(x.t0), EdgeV(x.t1))));
    const Bounds bounds = BoundsOf(w.n);
    const Choice above = hn::And(hn::Gt(Lowest(w.t0), bounds.t0), hn::Gt(Lowest(w.t1), bounds.t1));
    const Choice below = hn::And(hn::Lt(Highest(w.t0), hn::Neg(bounds.t0)), hn::Lt(Highest(w.t1), hn::Neg(bounds.t1)));
    return hn::Or(above, below);
  }

  static HWY_INLINE Vector LeastAt(const Instant& x, const Value* w) {
    if constexpr (kKind == PairKind::kEe) {
      return Minus(Choose<Near>(hn::Lt(w[1], w[0]), x.point[1], x.point[0]),
                   Choose<Near>(hn::Gt(w[3], w[2]), x.point[3], x.point[2]));
    } else {
      const Vector larger = Choose<Near>(hn::Gt(w[2], w[1]), x.point[2], x.point[1]);
      return Minus(x.point[0], Choose<Near>(hn::Gt(w[3], hn::Max(w[1], w[2])), x.point[3], larger));
    }
  }
  static HWY_INLINE Vector LeastDifference(const PointMotion& x, const Projection& w) {
    return Choose<Near>(hn::Lt(Lowest(w.t1), Lowest(w.t0)), LeastAt(x.t1, w.t1), LeastAt(x.t0, w.t0));
  }

  /// Candidates are sorted by their first feature, which therefore is mostly the same in all lanes.
  static HWY_INLINE bool AllAlike(const std::uint32_t* vertices) {
    const Place d;
    return hn::AllTrue(d, hn::Eq(hn::LoadU(d, vertices), hn::Set(d, *vertices)));
  }
  HWY_INLINE void Fill(std::uint32_t vertex, std::size_t k, PointMotion& x) const {
    const Near d;
    const float* row = rows_ + 8 * std::size_t{vertex};
    x.t0.point[k] = {hn::Set(d, row[0]), hn::Set(d, row[1]), hn::Set(d, row[2])};
    x.t1.point[k] = {hn::Set(d, row[4]), hn::Set(d, row[5]), hn::Set(d, row[6])};
  }
  HWY_INLINE void Read(const std::uint32_t* vertices, std::size_t k, PointMotion& x) const {
    x.t0.point[k] = ReadColumns(rows_, vertices);
    x.t1.point[k] = ReadColumns(rows_ + 4, vertices);
  }
  static HWY_INLINE void Keep(Choice apart, std::size_t count, hn::Vec<Place> numbers, PairNumbers& left) {
    const Choice open = hn::AndNot(apart, hn::FirstN(Near(), count));
    left.count += hn::CompressStore(numbers, hn::RebindMask(Place(), open), Place(), left.place.data() + left.count);
  }

  const float* rows_;
  const float last_factor_;
};

template <PairKind kKind>
void CullKind(const LaneMotion& motion, const LanePairs& pairs, float tolerance, PairNumbers& left) {
  const Look<kKind> look(motion, tolerance);
  look.LookAtAll(pairs, left);
  look.LookCloser(LanePairs(pairs, left), left);
}
void Cull(const LaneMotion& motion, const LanePairs& pairs, float tolerance, PairNumbers& left) {
  pairs.kind() == PairKind::kVf ? CullKind<PairKind::kVf>(motion, pairs, tolerance, left)
                                : CullKind<PairKind::kEe>(motion, pairs, tolerance, left);
}

}  // namespace selvage::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace selvage::detail {

HWY_EXPORT(Cull);

void cull_in_lanes(const LaneMotion& motion, const LanePairs& pairs, double tolerance, PairNumbers& left) {
  HWY_DYNAMIC_DISPATCH(Cull)(motion, pairs, near_tolerance(times_power_upper(tolerance, -motion.near_exponent)), left);
}

}  // namespace selvage::detail
#endif
