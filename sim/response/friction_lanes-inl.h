// Friction of contacts in SIMD lanes: what friction.h does to one pair of four vertices.
#if defined(SELVAGE_SIM_FRICTION_LANES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SELVAGE_SIM_FRICTION_LANES_INL_H
#undef SELVAGE_SIM_FRICTION_LANES_INL_H
#else
#define SELVAGE_SIM_FRICTION_LANES_INL_H
#endif

#include <array>

#include <hwy/highway.h>

#include "sim/base/lane_table-inl.h"
#include "sim/base/power_of_two-inl.h"
#include "sim/base/pseudo_inverse.h"
#include "sim/response/friction.h"

HWY_BEFORE_NAMESPACE();
namespace selvage::sim::HWY_NAMESPACE {

using Truth = hn::Mask<Real>;
using Values = std::array<Value, 4>;
using Vectors = std::array<Vector, 4>;

HWY_INLINE Vector Sum(const Vector& a, const Vector& b) { return lanes::Plus<Real>(a, b); }
HWY_INLINE Vector Difference(const Vector& a, const Vector& b) { return lanes::Minus<Real>(a, b); }
HWY_INLINE Vector Scaled(Value s, const Vector& a) { return lanes::Times<Real>(s, a); }
HWY_INLINE Value DotOf(const Vector& a, const Vector& b) { return lanes::Dot<Real>(a, b); }
HWY_INLINE Vector CrossOf(const Vector& a, const Vector& b) { return lanes::Cross<Real>(a, b); }
HWY_INLINE Vector Where(Truth truth, const Vector& a) { return lanes::Choose<Real>(truth, a, ZeroRows()); }
HWY_INLINE Value Number(double x) { return hn::Set(Real(), x); }
HWY_INLINE Value LargestOf(const Vector& a) {
  const Vector size = lanes::Absolute<Real>(a);
  return hn::Max(size.x, hn::Max(size.y, size.z));
}

/// Symmetric.
struct Matrix {
  Value xx, xy, xz, yy, yz, zz;
};
HWY_INLINE Vector Apply(const Matrix& m, const Vector& a) {
  return {DotOf({m.xx, m.xy, m.xz}, a), DotOf({m.xy, m.yy, m.yz}, a), DotOf({m.xz, m.yz, m.zz}, a)};
}

/// As relative() of an Interaction.
HWY_INLINE Vector Relative(const Values& weights, const Vectors& x) {
  Vector sum = ZeroRows();
  for (std::size_t i = 1; i < 4; ++i) sum = Sum(sum, Scaled(weights[i], Difference(x[i], x[0])));
  return sum;
}

HWY_INLINE Value EffectiveMobility(const Values& weights, const Values& mobility) {
  Value sum = hn::Zero(Real());
  for (std::size_t i = 0; i < 4; ++i) sum = hn::Add(sum, hn::Mul(hn::Mul(weights[i], weights[i]), mobility[i]));
  return sum;
}

/// pseudo_inverse() of each lane's matrix in the given lanes.
inline void InvertOneByOne(Truth which, Matrix& matrix) {
  const Real d;
  HWY_ALIGN double columns[6][kLanes];
  HWY_ALIGN double is_asked[kLanes];
  Value* const values[6] = {&matrix.xx, &matrix.xy, &matrix.xz, &matrix.yy, &matrix.yz, &matrix.zz};
  for (std::size_t k = 0; k < 6; ++k) hn::Store(*values[k], d, columns[k]);
  hn::Store(hn::IfThenElseZero(which, Number(1)), d, is_asked);
  for (std::size_t lane = 0; lane < hn::Lanes(d); ++lane) {
    if (is_asked[lane] == 0) continue;
    const auto at = [&](std::size_t k) { return columns[k][lane]; };
    Eigen::Matrix3d m;
    m << at(0), at(1), at(2), at(1), at(3), at(4), at(2), at(4), at(5);
    const Eigen::Matrix3d inverse = pseudo_inverse(m);
    const double entries[6] = {inverse(0, 0), inverse(0, 1), inverse(0, 2),
                               inverse(1, 1), inverse(1, 2), inverse(2, 2)};
    for (std::size_t k = 0; k < 6; ++k) columns[k][lane] = entries[k];
  }
  for (std::size_t k = 0; k < 6; ++k) *values[k] = hn::Load(d, columns[k]);
}

/// pseudo_inverse(): by cofactors where the rank is full by far, and one by one where not.
HWY_INLINE Matrix PseudoInverse(const Matrix& m, Truth which) {
  const Value xx = hn::Sub(hn::Mul(m.yy, m.zz), hn::Mul(m.yz, m.yz));
  const Value xy = hn::Sub(hn::Mul(m.xz, m.yz), hn::Mul(m.xy, m.zz));
  const Value xz = hn::Sub(hn::Mul(m.xy, m.yz), hn::Mul(m.xz, m.yy));
  const Value determinant = DotOf({m.xx, m.xy, m.xz}, {xx, xy, xz});
  const Value trace = hn::Add(hn::Add(m.xx, m.yy), m.zz);
  const Truth is_full = hn::Gt(determinant, hn::Mul(Number(kFullRank), hn::Mul(hn::Mul(trace, trace), trace)));
  const Value by = hn::Div(Number(1), determinant);
  const Value yy = hn::Sub(hn::Mul(m.xx, m.zz), hn::Mul(m.xz, m.xz));
  const Value yz = hn::Sub(hn::Mul(m.xy, m.xz), hn::Mul(m.xx, m.yz));
  const Value zz = hn::Sub(hn::Mul(m.xx, m.yy), hn::Mul(m.xy, m.xy));
  Matrix result{hn::Mul(by, xx), hn::Mul(by, xy), hn::Mul(by, xz), hn::Mul(by, yy), hn::Mul(by, yz), hn::Mul(by, zz)};
  const Truth is_left = hn::AndNot(is_full, which);
  if (hn::AllFalse(Real(), is_left)) return result;
  Matrix one_by_one = m;
  InvertOneByOne(is_left, one_by_one);
  const auto choose = [is_left](Value& value, Value other) HWY_ATTR { value = hn::IfThenElse(is_left, other, value); };
  choose(result.xx, one_by_one.xx);
  choose(result.xy, one_by_one.xy);
  choose(result.xz, one_by_one.xz);
  choose(result.yy, one_by_one.yy);
  choose(result.yz, one_by_one.yz);
  choose(result.zz, one_by_one.zz);
  return result;
}

/// As in an Interaction.
struct PairLanes {
  Values weights, mobility;
  Value effective;

  HWY_INLINE PairLanes(const Values& w, const Values& m)
      : weights(w), mobility(m), effective(EffectiveMobility(w, m)) {}
};

/// SlipGeometry: of pairs that are not closed y, r and the inverse inertia are zero.
struct SlipLanes {
  PairLanes pair;
  Truth is_closed;
  Values heaviness;  ///< 1 / mobility of closed pairs, else zero
  Vectors y;
  Vector r;
  Matrix inverse_inertia;
  Vector t, s;  ///< unit, across the normal
  Value stop_tt, stop_ts, stop_ss;

  /// Right in the lanes of `which` alone.
  HWY_INLINE SlipLanes(const PairLanes& lanes_of_pairs, const Vectors& x, const Vector& normal, Truth which)
      : pair(lanes_of_pairs) {
    const Value zero = hn::Zero(Real());
    is_closed = which;
    for (const Value& each : pair.mobility) is_closed = hn::And(is_closed, hn::Gt(each, zero));
    SetRotation(x);
    SetAxes(normal);
    const Vector about_t = CrossOf(r, t), about_s = CrossOf(r, s);
    const Vector turned_t = Apply(inverse_inertia, about_t), turned_s = Apply(inverse_inertia, about_s);
    const Matrix inverse =
        PseudoInverse({hn::Sub(pair.effective, DotOf(about_t, turned_t)), hn::Neg(DotOf(about_t, turned_s)), zero,
                       hn::Sub(pair.effective, DotOf(about_s, turned_s)), zero, pair.effective},
                      which);
    stop_tt = inverse.xx;
    stop_ts = inverse.xy;
    stop_ss = inverse.yy;
  }

  HWY_INLINE void SetRotation(const Vectors& x) {
    const Value zero = hn::Zero(Real()), one = Number(1);
    Value mass = zero;
    Vector center = ZeroRows();
    for (std::size_t i = 0; i < 4; ++i) {
      heaviness[i] = hn::IfThenElseZero(is_closed, hn::Div(one, pair.mobility[i]));
      mass = hn::Add(mass, heaviness[i]);
      center = Sum(center, Scaled(heaviness[i], Difference(x[i], x[0])));
    }
    center = Scaled(hn::Div(one, mass), center);
    Value largest = zero;
    for (std::size_t i = 0; i < 4; ++i) {
      y[i] = Where(is_closed, Difference(Difference(x[i], x[0]), center));
      largest = hn::Max(largest, LargestOf(y[i]));
    }
    const Value down = hn::Div(one, PowerOfTwoAbove<Real>(largest));  // exact
    Matrix inertia{zero, zero, zero, zero, zero, zero};
    for (std::size_t i = 0; i < 4; ++i) {
      y[i] = Scaled(down, y[i]);
      const Vector heavy = Scaled(heaviness[i], y[i]);
      const Value x_x = hn::Mul(heavy.x, y[i].x), y_y = hn::Mul(heavy.y, y[i].y), z_z = hn::Mul(heavy.z, y[i].z);
      inertia.xx = hn::Add(inertia.xx, hn::Add(y_y, z_z));
      inertia.yy = hn::Add(inertia.yy, hn::Add(x_x, z_z));
      inertia.zz = hn::Add(inertia.zz, hn::Add(x_x, y_y));
      inertia.xy = hn::Sub(inertia.xy, hn::Mul(heavy.x, y[i].y));
      inertia.xz = hn::Sub(inertia.xz, hn::Mul(heavy.x, y[i].z));
      inertia.yz = hn::Sub(inertia.yz, hn::Mul(heavy.y, y[i].z));
    }
    r = Relative(pair.weights, y);
    const Matrix inverse = PseudoInverse(inertia, is_closed);
    const auto closed = [this](Value value) HWY_ATTR { return hn::IfThenElseZero(is_closed, value); };
    inverse_inertia = {closed(inverse.xx), closed(inverse.xy), closed(inverse.xz),
                       closed(inverse.yy), closed(inverse.yz), closed(inverse.zz)};
  }

  HWY_INLINE void SetAxes(const Vector& n) {
    const Value zero = hn::Zero(Real());
    const Truth is_flat = hn::Lt(hn::Abs(n.z), Number(0.75));  // far from the axis that t is across
    const Value across = hn::IfThenElse(is_flat, n.x, n.z);
    const Value down = hn::Div(Number(1), hn::Sqrt(hn::Add(hn::Mul(n.y, n.y), hn::Mul(across, across))));
    const Value from_y = hn::Mul(down, n.y), from_across = hn::Mul(down, across);
    t = {hn::IfThenElse(is_flat, hn::Neg(from_y), zero), hn::IfThenElse(is_flat, from_across, hn::Neg(from_across)),
         hn::IfThenElse(is_flat, zero, from_y)};
    s = CrossOf(n, t);
  }

  /// The relative displacement without what a rigid rotation of the pair explains.
  [[nodiscard]] HWY_INLINE Vector SlipOf(const Vectors& displacement) const {
    Vector angular_momentum = ZeroRows();
    for (std::size_t i = 0; i < 4; ++i) {
      const Vector momentum = Scaled(heaviness[i], Difference(displacement[i], displacement[0]));
      angular_momentum = Sum(angular_momentum, CrossOf(y[i], momentum));
    }
    return Difference(Relative(pair.weights, displacement), CrossOf(Apply(inverse_inertia, angular_momentum), r));
  }

  [[nodiscard]] HWY_INLINE Vector ImpulseToStop(const Vector& slip) const {
    const Value along_t = DotOf(t, slip), along_s = DotOf(s, slip);
    const Value by_t = hn::Add(hn::Mul(stop_tt, along_t), hn::Mul(stop_ts, along_s));
    const Value by_s = hn::Add(hn::Mul(stop_ts, along_t), hn::Mul(stop_ss, along_s));
    return Scaled(Number(-1), Sum(Scaled(by_t, t), Scaled(by_s, s)));
  }

  [[nodiscard]] HWY_INLINE Vectors ChangesBy(const Vector& impulse) const {
    const Vector rotation_back = Apply(inverse_inertia, CrossOf(r, impulse));
    Vectors changes;
    for (std::size_t i = 0; i < 4; ++i) {
      changes[i] =
          Difference(Scaled(hn::Mul(pair.mobility[i], pair.weights[i]), impulse), CrossOf(rotation_back, y[i]));
    }
    return changes;
  }
};

/// adds_energy() of friction.cpp.
HWY_INLINE Truth AddsEnergy(const SlipLanes& slip, const Vectors& displacement, const Vectors& change) {
  Vector heaviest = displacement[0];
  Value least = slip.pair.mobility[0];
  for (std::size_t i = 1; i < 4; ++i) {
    const Truth is_heavier = hn::Lt(slip.pair.mobility[i], least);
    heaviest = lanes::Choose<Real>(is_heavier, displacement[i], heaviest);
    least = hn::IfThenElse(is_heavier, slip.pair.mobility[i], least);
  }
  Value added = hn::Zero(Real()), energy = hn::Zero(Real());
  for (std::size_t i = 0; i < 4; ++i) {
    const Vector own = Difference(displacement[i], heaviest);
    const Vector twice = Sum(Sum(own, own), change[i]);
    added = hn::Add(added, hn::Mul(slip.heaviness[i], DotOf(change[i], twice)));
    energy = hn::Add(energy, hn::Mul(slip.heaviness[i], DotOf(own, own)));
  }
  return hn::Not(hn::Le(added, hn::Mul(Number(kFrictionRounding), energy)));
}

}  // namespace selvage::sim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
