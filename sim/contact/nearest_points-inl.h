// Nearest points of pairs in plain doubles, in SIMD lanes (quick_proximity.h).
#if defined(SELVAGE_SIM_NEAREST_POINTS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SELVAGE_SIM_NEAREST_POINTS_INL_H
#undef SELVAGE_SIM_NEAREST_POINTS_INL_H
#else
#define SELVAGE_SIM_NEAREST_POINTS_INL_H
#endif

#include <limits>

#include <hwy/highway.h>

#include "kernel/lanes/lane_vector-inl.h"
#include "kernel/types.h"
#include "sim/base/power_of_two-inl.h"

HWY_BEFORE_NAMESPACE();
namespace selvage::sim::HWY_NAMESPACE {

using detail::HWY_NAMESPACE::Absolute;
using detail::HWY_NAMESPACE::Cross;
using detail::HWY_NAMESPACE::Dot;
using detail::HWY_NAMESPACE::Largest;
using detail::HWY_NAMESPACE::Minus;
using detail::HWY_NAMESPACE::Plus;
using detail::HWY_NAMESPACE::Times;
using detail::HWY_NAMESPACE::Value3;

/// One pair a lane; the functions below say what happens in each. Comparisons with NaN are false on every target.
template <class D>
struct Nearest {
  using Value = hn::Vec<D>;
  using Vector = Value3<D>;

  /// Of the pair's vertices after the first, which is the origin.
  struct Weights {
    Value of[3];
  };

  static HWY_INLINE Value Within01(Value share) {
    const Value zero = hn::Zero(D()), one = hn::Set(D(), 1.0);
    return hn::IfThenElse(hn::Lt(share, zero), zero, hn::IfThenElse(hn::Lt(one, share), one, share));
  }

  /// The nearest of the points a (1 - s) + b s on an edge of the triangle, if nearer than `best`.
  template <std::size_t kA, std::size_t kB>
  static HWY_INLINE void ConsiderEdge(const Vector* corner, Value& best, Weights& weights) {
    const Vector &a = corner[kA], ab = Minus<D>(corner[kB], a);
    const Value share = Within01(hn::Div(hn::Neg(Dot<D>(a, ab)), Dot<D>(ab, ab)));
    const Vector point = Plus<D>(a, Times<D>(share, ab));
    const Value squared = Dot<D>(point, point);
    const auto is_farther = hn::Ge(squared, best);
    best = hn::IfThenElse(is_farther, best, squared);
    weights.of[kA] = hn::IfThenElse(is_farther, weights.of[kA], hn::Sub(hn::Set(D(), 1.0), share));
    weights.of[kB] = hn::IfThenElse(is_farther, weights.of[kB], share);
    weights.of[3 - kA - kB] = hn::IfThenElse(is_farther, weights.of[3 - kA - kB], hn::Zero(D()));
  }

  /// Of the origin and a face.
  static HWY_INLINE Weights Vf(const Vector* corner) {
    const Value zero = hn::Zero(D());
    const Vector normal = Cross<D>(Minus<D>(corner[1], corner[0]), Minus<D>(corner[2], corner[0]));
    const Value areas[3] = {Dot<D>(Cross<D>(corner[1], corner[2]), normal),
                            Dot<D>(Cross<D>(corner[2], corner[0]), normal),
                            Dot<D>(Cross<D>(corner[0], corner[1]), normal)};
    const auto is_inside = hn::And(hn::Gt(areas[0], zero), hn::And(hn::Gt(areas[1], zero), hn::Gt(areas[2], zero)));
    Value best = hn::Set(D(), std::numeric_limits<double>::infinity());
    Weights weights{{zero, zero, zero}};
    ConsiderEdge<0, 1>(corner, best, weights);
    ConsiderEdge<1, 2>(corner, best, weights);
    ConsiderEdge<2, 0>(corner, best, weights);
    const Value sum = hn::Add(hn::Add(areas[0], areas[1]), areas[2]);
    for (std::size_t k = 0; k < 3; ++k) {
      weights.of[k] = hn::Neg(hn::IfThenElse(is_inside, hn::Div(areas[k], sum), weights.of[k]));
    }
    return weights;
  }

  /// Of an edge from the origin to b and one from c to d: the unbounded lines' nearest points, the first share bounded;
  /// then each the other's nearest in turn (Ericson).
  static HWY_INLINE Weights Ee(const Vector& b, const Vector& c, const Vector& d) {
    const Vector v = Minus<D>(d, c);
    const Value uu = Dot<D>(b, b), uv = Dot<D>(b, v), vv = Dot<D>(v, v), ur = hn::Neg(Dot<D>(b, c)),
                vr = hn::Neg(Dot<D>(v, c));
    const Value sine_squared = hn::Sub(hn::Mul(uu, vv), hn::Mul(uv, uv));
    const Value on_line = Within01(hn::Div(hn::Sub(hn::Mul(uv, vr), hn::Mul(ur, vv)), sine_squared));
    const Value first = hn::IfThenElseZero(hn::Gt(sine_squared, hn::Zero(D())), on_line);
    const Value t = Within01(hn::Div(hn::Add(hn::Mul(uv, first), vr), vv));
    const Value s = Within01(hn::Div(hn::Sub(hn::Mul(uv, t), ur), uu));
    return {{s, hn::Sub(t, hn::Set(D(), 1.0)), hn::Neg(t)}};
  }

  Value distance;
  Vector direction;
  Value first_weight;
  Weights weights;

  /// x: the pair's vertices.
  template <PairKind kKind>
  static HWY_INLINE Nearest Of(const Vector* x) {
    Vector y[3], largest{hn::Zero(D()), hn::Zero(D()), hn::Zero(D())};
    for (std::size_t k = 0; k < 3; ++k) {
      y[k] = Minus<D>(x[k + 1], x[0]);
      largest = Largest<D>(largest, Absolute<D>(y[k]));
    }
    // So scaled products of four lengths neither overflow nor vanish.
    const Value scale = PowerOfTwoAbove<D>(hn::Max(largest.x, hn::Max(largest.y, largest.z)));
    const Value down = hn::Div(hn::Set(D(), 1.0), scale);  // exact
    for (Vector& v : y) v = Times<D>(down, v);
    Nearest result;
    if constexpr (kKind == PairKind::kVf) {
      result.weights = Vf(y);
      result.first_weight = hn::Set(D(), 1.0);
    } else {
      result.weights = Ee(y[0], y[1], y[2]);
      result.first_weight = hn::Sub(hn::Set(D(), 1.0), result.weights.of[0]);
    }
    const Value* w = result.weights.of;
    const Vector difference = Plus<D>(Plus<D>(Times<D>(w[0], y[0]), Times<D>(w[1], y[1])), Times<D>(w[2], y[2]));
    const Value length = hn::Sqrt(Dot<D>(difference, difference));
    result.distance = hn::Mul(length, scale);
    result.direction = {hn::Div(difference.x, length), hn::Div(difference.y, length), hn::Div(difference.z, length)};
    return result;
  }
};

}  // namespace selvage::sim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
