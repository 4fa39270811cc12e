// The straight-line part of plane_passage.h, for as many pairs at once as D has lanes. A single query is one lane of
// the same code, so that lists and single queries answer with the same bits. Bounds: rounding.h.
#if defined(SELVAGE_KERNEL_PLANE_PASSAGE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SELVAGE_KERNEL_PLANE_PASSAGE_INL_H
#undef SELVAGE_KERNEL_PLANE_PASSAGE_INL_H
#else
#define SELVAGE_KERNEL_PLANE_PASSAGE_INL_H
#endif

#include "kernel/arithmetic/rounding.h"
#include "kernel/lanes/lane_vector-inl.h"
#include "kernel/query/plane_passage.h"

HWY_BEFORE_NAMESPACE();
namespace selvage::detail::HWY_NAMESPACE {

/// As DifferencePolygon, one a lane. A vf pair has no last corner, an ee pair no edge_w.
template <class D>
struct LanePolygon {
  Value3<D> corner[4], edge_u, edge_v, edge_w;
};
/// As PairMotion: scaled so that the largest component of a corner is in [0.5, 1).
template <class D>
struct LanePolygonMotion {
  LanePolygon<D> t0, t1;
  Value3<D> extent;
};

/// Where lanes are in contact.
template <class D>
struct LaneTouch {
  hn::Vec<D> tick, gap, weight[4];
  Value3<D> normal;

  HWY_INLINE LaneTouch() {
    tick = gap = weight[0] = weight[1] = weight[2] = weight[3] = normal.x = normal.y = normal.z = hn::Zero(D());
  }
};

/// What is known of each lane: separated or in contact, neither of them, or more parts of the step to look at.
template <class D>
struct LanePassages {
  hn::Mask<D> separated, contact, open;
  hn::Vec<D> intervals;
};

template <PairKind kKind, class D>
class PlanePassages {
  using Value = hn::Vec<D>;
  using Choice = hn::Mask<D>;
  using Vector = Value3<D>;
  using Number = hn::Vec<hn::RebindToSigned<D>>;
  static constexpr std::size_t kCorners = kKind == PairKind::kEe ? 4 : 3;

 public:
  explicit HWY_INLINE PlanePassages(const LanePolygonMotion<D>& motion) : motion_(motion) {
    const LanePolygon<D>&begin = motion.t0, &end = motion.t1;
    const Vector first = Cross(begin.edge_u, begin.edge_v), last = Cross(end.edge_u, end.edge_v);
    const Vector middle_doubled = Plus(Cross(begin.edge_u, end.edge_v), Cross(end.edge_u, begin.edge_v));
    const Value three = Set(3);
    cubic_.c[0] = hn::Mul(three, Dot(first, begin.corner[0]));
    cubic_.c[1] = hn::Add(Dot(middle_doubled, begin.corner[0]), Dot(first, end.corner[0]));
    cubic_.c[2] = hn::Add(Dot(last, begin.corner[0]), Dot(middle_doubled, end.corner[0]));
    cubic_.c[3] = hn::Mul(three, Dot(last, end.corner[0]));
    const Value permanent = Permanent(ExtentOf(begin.edge_u, end.edge_u), ExtentOf(begin.edge_v, end.edge_v),
                                      ExtentOf(begin.corner[0], end.corner[0]));
    bound_ = hn::Add(hn::Mul(Set(kDeterminantError<double> + kBlossomError<double>), hn::Mul(three, permanent)),
                     Set(kUnderflowError));
  }

  /// Looks at the whole step.
  HWY_INLINE LanePassages<D> Whole(LaneTouch<D>& touch) {
    const Choice all = hn::FirstN(D(), hn::Lanes(D()));
    const Look look = Examine(cubic_, Set(0), Set(1), all, touch);
    return {look.clear, look.contact, look.split, hn::Add(Set(1), look.roots)};
  }

  /// Looks at parts of the step where the whole of it was split: from left to right, in halves of halves, until one is
  /// in contact or unclear.
  HWY_INLINE LanePassages<D> Parts(LaneTouch<D>& touch) {
    const hn::RebindToSigned<D> n;
    const Value part = Set(1.0 / kParts);
    Number place = hn::Zero(n), count = hn::Set(n, kParts / 2);
    const Choice all = hn::FirstN(D(), hn::Lanes(D()));
    LanePassages<D> found = {hn::Not(all), hn::Not(all), all, Set(1)};
    while (!hn::AllFalse(D(), found.open)) {
      const Value begin = hn::Mul(hn::ConvertTo(D(), place), part), width = hn::Mul(hn::ConvertTo(D(), count), part);
      const Look look = Examine(LocalCubic(begin, hn::Add(begin, width)), begin, width, found.open, touch);
      found.intervals = hn::Add(found.intervals, hn::IfThenElseZero(found.open, hn::Add(Set(1), look.roots)));
      found.contact = hn::Or(found.contact, look.contact);
      const auto clear = hn::RebindMask(n, look.clear), split = hn::RebindMask(n, look.split);
      place = hn::IfThenElse(clear, hn::Add(place, count), place);
      // The largest part that starts at a place, after what has been looked at, is its lowest bit.
      count = hn::IfThenElse(clear, hn::And(place, hn::Neg(place)), count);
      count = hn::IfThenElse(split, hn::ShiftRight<1>(count), count);
      const Choice at_end = hn::RebindMask(D(), hn::Eq(place, hn::Set(n, kParts)));
      const Choice narrow = hn::RebindMask(D(), hn::Eq(count, hn::Zero(n)));
      found.separated = hn::Or(found.separated, hn::And(look.clear, at_end));
      found.open = hn::Or(hn::AndNot(at_end, look.clear), hn::AndNot(narrow, look.split));
    }
    return found;
  }

  /// Whether the features are farther apart than `tolerance`, scaled, at t = 1: as far as their planes or lines are.
  HWY_INLINE Choice EndsBeyond(Value tolerance) const {
    const Vector n = Cross(motion_.t1.edge_u, motion_.t1.edge_v);
    Value lowest = Dot(n, motion_.t1.corner[0]), highest = lowest;
    HWY_UNROLL(3)
    for (std::size_t i = 1; i < kCorners; ++i) {
      const Value support = Dot(n, motion_.t1.corner[i]);
      lowest = hn::Min(lowest, support);
      highest = hn::Max(highest, support);
    }
    const Value margin = hn::Sub(hn::Max(lowest, hn::Neg(highest)), SupportError(n));
    return hn::Gt(hn::Mul(margin, Set(1 - kQuotientError)), hn::Mul(tolerance, SumOf(Absolute(n))));
  }

 private:
  struct Cubic {
    Value c[4];
  };
  struct Look {
    Choice clear, contact, split;  ///< none: unclear
    Value roots;                   ///< looked at
  };
  struct Moment {
    Value before, after;  ///< s = 1 - t and t, both exact
  };

  static HWY_INLINE Value Set(double value) { return hn::Set(D(), value); }
  static HWY_INLINE Vector ExtentOf(const Vector& a, const Vector& b) { return Largest(Absolute(a), Absolute(b)); }
  static HWY_INLINE Value Permanent(const Vector& a, const Vector& b, const Vector& c) {
    const auto minor = [](Value p, Value q, Value r, Value s)
                           HWY_ATTR { return hn::Add(hn::Mul(p, q), hn::Mul(r, s)); };
    const Vector minors = {minor(a.y, b.z, a.z, b.y), minor(a.z, b.x, a.x, b.z), minor(a.x, b.y, a.y, b.x)};
    return Dot(minors, c);
  }
  static HWY_INLINE Value Blend(Value a, Value b, const Moment& at) {
    return hn::Add(hn::Mul(at.before, a), hn::Mul(at.after, b));
  }
  static HWY_INLINE Vector Blend(const Vector& a, const Vector& b, const Moment& at) {
    return {Blend(a.x, b.x, at), Blend(a.y, b.y, at), Blend(a.z, b.z, at)};
  }
  static HWY_INLINE Moment AtTime(Value t) { return {hn::Sub(Set(1), t), t}; }

  HWY_INLINE Value SupportError(const Vector& n) const {
    return hn::Add(hn::Mul(Set(kSupportError<double>), Dot(Absolute(n), motion_.extent)), Set(kUnderflowError));
  }

  /// The cubic at a time (De Casteljau).
  HWY_INLINE Value ValueAt(const Moment& at) const {
    const auto& c = cubic_.c;
    const Value a = Blend(c[0], c[1], at), b = Blend(c[1], c[2], at), d = Blend(c[2], c[3], at);
    return Blend(Blend(a, b, at), Blend(b, d, at), at);
  }
  /// Its Bernstein coefficients over a part of the step: the blossom (coplanarity.cpp).
  HWY_INLINE Cubic LocalCubic(Value begin, Value end) const {
    const Moment b = AtTime(begin), e = AtTime(end);
    const auto& c = cubic_.c;
    const Value b0 = Blend(c[0], c[1], b), b1 = Blend(c[1], c[2], b), b2 = Blend(c[2], c[3], b);
    const Value e0 = Blend(c[0], c[1], e), e1 = Blend(c[1], c[2], e), e2 = Blend(c[2], c[3], e);
    const Value bb0 = Blend(b0, b1, b), bb1 = Blend(b1, b2, b);
    const Value be0 = Blend(b0, b1, e), be1 = Blend(b1, b2, e);
    const Value ee0 = Blend(e0, e1, e), ee1 = Blend(e1, e2, e);
    return {{Blend(bb0, bb1, b), Blend(bb0, bb1, e), Blend(be0, be1, e), Blend(ee0, ee1, e)}};
  }
  HWY_INLINE LanePolygon<D> PolygonAt(const Moment& at) const {
    LanePolygon<D> polygon;
    HWY_UNROLL(4)
    for (std::size_t i = 0; i < kCorners; ++i) {
      polygon.corner[i] = Blend(motion_.t0.corner[i], motion_.t1.corner[i], at);
    }
    polygon.edge_u = Blend(motion_.t0.edge_u, motion_.t1.edge_u, at);
    polygon.edge_v = Blend(motion_.t0.edge_v, motion_.t1.edge_v, at);
    if constexpr (kKind == PairKind::kVf) polygon.edge_w = Blend(motion_.t0.edge_w, motion_.t1.edge_w, at);
    return polygon;
  }

  /// A part of the step with its coefficients, in the lanes of `open`.
  HWY_INLINE Look Examine(const Cubic& cubic, Value begin, Value width, Choice open, LaneTouch<D>& touch) {
    const auto& c = cubic.c;
    const Value low = hn::Neg(bound_);
    const Value least = hn::Min(hn::Min(c[0], c[1]), hn::Min(c[2], c[3]));
    const Value greatest = hn::Max(hn::Max(c[0], c[1]), hn::Max(c[2], c[3]));
    const Choice definite = hn::And(open, hn::Or(hn::Gt(least, bound_), hn::Lt(greatest, low)));
    const Choice rises = hn::And(hn::Lt(c[0], low), hn::Gt(c[3], bound_));
    const Choice falls = hn::And(hn::Gt(c[0], bound_), hn::Lt(c[3], low));
    const Value flip = hn::IfThenElseZero(falls, hn::SignBit(D()));
    const Cubic rising = {{hn::Xor(c[0], flip), hn::Xor(c[1], flip), hn::Xor(c[2], flip), hn::Xor(c[3], flip)}};
    // By Descartes' rule: whatever the signs that the bound leaves open, the four change sign once.
    const Choice once = hn::Or(hn::Lt(rising.c[1], low), hn::Gt(rising.c[2], bound_));
    const Choice simple = hn::And(hn::And(open, once), hn::Or(rises, falls));
    const Choice split = hn::AndNot(hn::Or(definite, simple), open);
    if (hn::AllFalse(D(), simple)) return {definite, simple, split, Set(0)};
    const PassedBy passed = Pass(rising, flip, begin, width, simple, touch);
    return {hn::Or(definite, passed.beside), passed.contact, split, hn::IfThenElseZero(simple, Set(1))};
  }

  /// The root in [0,1] of a cubic that rises through zero, as a fraction of its part: a guess. Halley's method, kept
  /// inside the bracket. The first steps ask no question, so that the next lanes' work need not wait for the answer.
  struct Root {
    Value at, slope;
  };
  HWY_INLINE Root RootOf(const Cubic& rising, Choice simple) const {
    const auto& c = rising.c;
    const Value three = Set(3), residual = hn::Mul(Set(0.125), bound_);
    const Value inner = hn::Sub(c[2], c[1]), outer = hn::Sub(c[1], c[0]);
    const Value linear = hn::Mul(three, outer), square = hn::Mul(three, hn::Sub(inner, outer));
    const Value cube = hn::Sub(hn::Sub(c[3], c[0]), hn::Mul(three, inner)), cube3 = hn::Mul(three, cube);
    const Value square2 = hn::Add(square, square);
    Value low = Set(0), high = Set(1), t = hn::Div(c[0], hn::Sub(c[0], c[3])), slope = linear;
    for (int step = 0; step < kRootSteps; ++step) {
      const Value value = hn::Add(hn::Mul(hn::Add(hn::Mul(hn::Add(hn::Mul(cube, t), square), t), linear), t), c[0]);
      slope = hn::Add(hn::Mul(hn::Add(hn::Mul(cube3, t), square2), t), linear);
      const Choice below = hn::Lt(value, Set(0));
      low = hn::IfThenElse(below, t, low);
      high = hn::IfThenElse(below, high, t);
      const Value half_curvature = hn::Add(hn::Mul(cube3, t), square);
      const Value denominator = hn::Sub(hn::Mul(slope, slope), hn::Mul(value, half_curvature));
      const Value next = hn::Sub(t, hn::Div(hn::Mul(value, slope), denominator));
      const Choice inside = hn::And(hn::Gt(next, low), hn::Lt(next, high));
      const Value better = hn::IfThenElse(inside, next, hn::Mul(Set(0.5), hn::Add(low, high)));
      const Choice seeking = hn::Gt(hn::Abs(value), residual);
      t = hn::IfThenElse(seeking, better, t);
      if (step >= kLikelySteps && hn::AllFalse(D(), hn::And(simple, seeking))) break;
    }
    return {t, slope};
  }

  /// Looks at the one root of a part: the features pass beside each other, which clears the part, or are in contact.
  struct PassedBy {
    Choice beside, contact;
  };
  HWY_INLINE PassedBy Pass(const Cubic& rising, Value flip, Value begin, Value width, Choice simple,
                           LaneTouch<D>& touch) {
    const Root root = RootOf(rising, simple);
    const Value margin = hn::Div(hn::Mul(Set(1.5), bound_), hn::Abs(root.slope)), one = Set(1);
    const Value ticks_of_step = Set(0x1p52), ticks = hn::Mul(width, ticks_of_step);
    const Value first = hn::Sub(hn::Floor(hn::Mul(hn::Sub(root.at, margin), ticks)), one);
    const Value last = hn::Add(hn::Ceil(hn::Mul(hn::Add(root.at, margin), ticks)), one);
    const Choice within = hn::And(hn::Gt(first, Set(0)), hn::Lt(last, ticks));
    const Choice is_short = hn::Le(hn::Sub(last, first), Set(static_cast<double>(kShortWidth)));
    const Value tick = hn::Add(hn::Mul(begin, ticks_of_step), first), end = hn::Add(tick, hn::Sub(last, first));
    const Moment at_begin = AtTime(hn::Mul(tick, Set(0x1p-52))), at_end = AtTime(hn::Mul(end, Set(0x1p-52)));
    const Choice below = hn::Lt(hn::Xor(ValueAt(at_begin), flip), hn::Neg(bound_));
    const Choice above = hn::Gt(hn::Xor(ValueAt(at_end), flip), bound_);
    const Choice bracketed = hn::And(hn::And(simple, hn::And(within, is_short)), hn::And(below, above));

    const LanePolygon<D> polygon = PolygonAt(at_begin);
    const Crossing crossing = CrossingOf(polygon);
    const Choice beside = hn::And(hn::And(bracketed, hn::Lt(crossing.depth, Set(0))),
                                  Separates(polygon, PolygonAt(at_end), crossing.outward));
    const Choice inside = hn::And(bracketed, hn::Gt(crossing.depth, Set(kInnerDepth)));
    if (hn::AllFalse(D(), inside)) return {beside, inside};
    const Value gap = GapUpper(polygon, crossing);
    const Choice contact = hn::And(inside, hn::Le(gap, Set(kAlarmGap)));
    touch.tick = hn::IfThenElse(contact, tick, touch.tick);
    touch.gap = hn::IfThenElse(contact, gap, touch.gap);
    for (std::size_t i = 0; i < 4; ++i) {
      touch.weight[i] = hn::IfThenElse(contact, crossing.weight[i], touch.weight[i]);
    }
    // The cubic is 3 normal . corner: where it falls the origin comes from the other side of the polygon.
    const Value factor = hn::Xor(hn::Div(one, hn::Sqrt(crossing.normal_squared)), hn::Xor(flip, hn::SignBit(D())));
    touch.normal = Choose<D>(contact, Times<D>(factor, crossing.normal), touch.normal);
    return {beside, contact};
  }

  HWY_INLINE Choice Separates(const LanePolygon<D>& begin, const LanePolygon<D>& end, const Vector& n) const {
    Value least = hn::Min(Dot(n, begin.corner[0]), Dot(n, end.corner[0]));
    HWY_UNROLL(3)
    for (std::size_t i = 1; i < kCorners; ++i) {
      least = hn::Min(least, hn::Min(Dot(n, begin.corner[i]), Dot(n, end.corner[i])));
    }
    return hn::Gt(least, SupportError(n));
  }

  /// The point of the polygon's plane that is nearest to the origin: good to rounding times the polygon's condition.
  struct Crossing {
    Value weight[4];  ///< of the points of the pair, as in ClosestPoint, but of either sign
    Vector normal;    ///< edge_u x edge_v
    Value normal_squared;
    Value depth;     ///< from the point to the polygon's border at least, negative outside
    Vector outward;  ///< in the plane, orthogonal to an edge that the point is beyond, away from the polygon
  };
  // The point is r + alpha u + beta v with r = corner[0]; n = u x v, so that alpha n^2 = (v x r) . n and
  // beta n^2 = (r x u) . n. Each edge of the polygon is at alpha or beta = 0, or at alpha + beta = 1 (vf), or alpha or
  // beta = 1 (ee). An edge e with the polygon to its left, seen from n, has n x e pointing inward.
  static HWY_INLINE Crossing CrossingOf(const LanePolygon<D>& polygon) {
    const Vector &r = polygon.corner[0], &u = polygon.edge_u, &v = polygon.edge_v;
    Crossing crossing;
    const Vector n = crossing.normal = Cross(u, v);
    const Value n_squared = crossing.normal_squared = Dot(n, n), one = Set(1);
    const Value alpha = hn::Div(Dot(Cross(v, r), n), n_squared), beta = hn::Div(Dot(Cross(r, u), n), n_squared);
    const Value alpha_rest = hn::Sub(one, alpha);
    Value longest_squared = hn::Max(Dot(u, u), Dot(v, v));
    Value least = alpha;  // how far inside, as a share of the height over the edge that is nearest in this sense
    Vector across = v, tail = n;  // outward = across x tail
    const auto consider = [&](Value share, const Vector& first, const Vector& second) HWY_ATTR {
      const Choice less = hn::Lt(share, least);
      least = hn::IfThenElse(less, share, least);
      across = Choose<D>(less, first, across);
      tail = Choose<D>(less, second, tail);
    };
    consider(beta, n, u);
    if constexpr (kKind == PairKind::kVf) {
      longest_squared = hn::Max(longest_squared, Dot(polygon.edge_w, polygon.edge_w));
      crossing.weight[0] = one;
      crossing.weight[1] = hn::Sub(alpha_rest, beta);
      crossing.weight[2] = alpha;
      crossing.weight[3] = beta;
      consider(crossing.weight[1], n, polygon.edge_w);
    } else {
      crossing.weight[0] = alpha_rest;
      crossing.weight[1] = alpha;
      crossing.weight[2] = hn::Sub(one, beta);
      crossing.weight[3] = beta;
      consider(crossing.weight[0], n, v);
      consider(crossing.weight[2], u, n);
    }
    crossing.depth = hn::Mul(least, hn::Sqrt(hn::Div(n_squared, longest_squared)));
    crossing.outward = Cross(across, tail);
    return crossing;
  }

  /// As distance_upper (separation.h). One extent is at least 0.5, so that the norm needs no scaling of its own: what
  /// underflows in it is less than 2^-900 of it.
  HWY_INLINE Value GapUpper(const LanePolygon<D>& polygon, const Crossing& crossing) const {
    Value w[4];
    if constexpr (kKind == PairKind::kVf) {
      for (std::size_t i = 0; i < 3; ++i) w[i] = crossing.weight[i + 1];
    } else {
      for (std::size_t i = 0; i < 4; ++i) w[i] = hn::Mul(crossing.weight[i / 2], crossing.weight[2 + i % 2]);
    }
    Vector sum = Times<D>(w[0], polygon.corner[0]), total = Absolute(sum);
    Value weight_total = w[0];
    HWY_UNROLL(3)
    for (std::size_t i = 1; i < kCorners; ++i) {
      const Vector term = Times<D>(w[i], polygon.corner[i]);
      sum = Plus(sum, term);
      total = Plus(total, Absolute(term));
      weight_total = hn::Add(weight_total, w[i]);
    }
    const Vector worst =
        Plus(Plus(Absolute(sum), Times<D>(Set(kWitnessError), total)), Times<D>(Set(kBlendError), motion_.extent));
    const Value length = hn::Sqrt(Dot(worst, worst));
    return hn::Add(hn::Mul(hn::Div(length, weight_total), Set(1 + kWitnessQuotientError)), Set(kUnderflowError));
  }

  /// Steps on a bracketed simple root: from within 2^-4 of it three reach the precision of doubles.
  static constexpr int kRootSteps = 8, kLikelySteps = 3;
  /// Parts of the step at the most.
  static constexpr int kParts = 16;

  const LanePolygonMotion<D>& motion_;
  Cubic cubic_;
  Value bound_;  ///< PROVED: of each coefficient, and of every value computed from them
};

}  // namespace selvage::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // SELVAGE_KERNEL_PLANE_PASSAGE_INL_H
