#include "sim/dynamics/half_kicks.h"

#include "sim/base/parallel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sim/dynamics/half_kicks.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "sim/base/lane_table-inl.h"

HWY_BEFORE_NAMESPACE();
namespace selvage::sim::HWY_NAMESPACE {

/// Of the kick of the half step whose drag is explicit: without, drag turned a motion round for rates above 2 / h. With
/// x the rate times h/2, drag alone leaves 1 - share x = (1 + x) / (1 + 2 x + 2 x^2) of a velocity: never below zero;
/// to second order 1 - x, which goes with the 1 / (1 + x) of the other half step; and where x is large 1 / (2 x), which
/// takes a vertex as far in the step as drag lets it.
HWY_INLINE Value ShareOfKick(Value x) {
  const Value one = hn::Set(Real(), 1.0), twice = hn::Add(x, x);
  return hn::Div(one, hn::Add(one, hn::Mul(x, hn::Div(twice, hn::Add(one, twice)))));
}

HWY_INLINE Vector Broadcast(const Vec3& value) {
  const Real d;
  return {hn::Set(d, value.x()), hn::Set(d, value.y()), hn::Set(d, value.z())};
}

void ExplicitHalfKick(const HalfKick& kick, const LaneScalars& inverse_mass, const LaneVectors& forces,
                      const LaneVectors& impulses, const LaneVectors& positions, Eigen::Index begin, Eigen::Index end,
                      LaneVectors& velocities, LaneVectors& x_t1) {
  const Real d;
  const Axes force(forces), impulse(impulses), x(positions), v(velocities);
  const Value h = hn::Set(d, kick.h), half = hn::Set(d, kick.h / 2);
  const Value linear_1_s = hn::Set(d, kick.fields.drag_1_s), quadratic_1_m = hn::Set(d, kick.fields.quadratic_drag_1_m);
  const Vector gravity = Broadcast(kick.fields.gravity_m_s2);
  for (Eigen::Index row = begin; row < end; row += VectorRows()) {
    const Value w = hn::LoadU(d, inverse_mass.data() + row);
    const Vector before = ReadRows(v, row);
    const Value speed = hn::Sqrt(lanes::Dot<Real>(before, before));
    const Value drag_1_s = hn::Add(linear_1_s, hn::Mul(quadratic_1_m, speed));
    const Vector acceleration = lanes::Plus<Real>(lanes::Minus<Real>(gravity, lanes::Times<Real>(drag_1_s, before)),
                                                  lanes::Times<Real>(w, ReadRows(force, row)));
    const Vector change =
        lanes::Minus<Real>(lanes::Times<Real>(half, acceleration), lanes::Times<Real>(w, ReadRows(impulse, row)));
    const Vector kicked = lanes::Plus<Real>(before, lanes::Times<Real>(ShareOfKick(hn::Mul(half, drag_1_s)), change));
    const Vector after = lanes::Choose<Real>(hn::Gt(w, hn::Zero(d)), kicked, before);
    WriteRows(after, velocities, row);
    WriteRows(lanes::Plus<Real>(ReadRows(x, row), lanes::Times<Real>(h, after)), x_t1, row);
  }
}

void ElasticHalfKick(const HalfKick& kick, const LaneScalars& inverse_mass, const LaneVectors& forces,
                     const LaneVectors& velocities, Eigen::Index begin, Eigen::Index end, LaneVectors& kicked) {
  const Real d;
  const Axes force(forces), v(velocities);
  const Value half = hn::Set(d, kick.h / 2);
  const Vector gravity = Broadcast(kick.fields.gravity_m_s2);
  for (Eigen::Index row = begin; row < end; row += VectorRows()) {
    const Value w = hn::LoadU(d, inverse_mass.data() + row);
    const Vector before = ReadRows(v, row);
    const Vector acceleration = lanes::Plus<Real>(gravity, lanes::Times<Real>(w, ReadRows(force, row)));
    const Vector after = lanes::Plus<Real>(before, lanes::Times<Real>(half, acceleration));
    WriteRows(lanes::Choose<Real>(hn::Gt(w, hn::Zero(d)), after, before), kicked, row);
  }
}

}  // namespace selvage::sim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace selvage::sim {

HWY_EXPORT(ExplicitHalfKick);
HWY_EXPORT(ElasticHalfKick);

void explicit_half_kick(const HalfKick& kick, const LaneScalars& inverse_mass, const LaneVectors& force,
                        const LaneVectors& impulses, const LaneVectors& x, LaneVectors& v, LaneVectors& x_t1) {
  x_t1.resize(x.rows());
  parallel_blocks(v.rows(), [&](Eigen::Index begin, Eigen::Index end) {
    HWY_DYNAMIC_DISPATCH(ExplicitHalfKick)(kick, inverse_mass, force, impulses, x, begin, end, v, x_t1);
  });
}

void elastic_half_kick(const HalfKick& kick, const LaneScalars& inverse_mass, const LaneVectors& force,
                       const LaneVectors& v, LaneVectors& kicked) {
  kicked.resize(v.rows());
  parallel_blocks(v.rows(), [&](Eigen::Index begin, Eigen::Index end) {
    HWY_DYNAMIC_DISPATCH(ElasticHalfKick)(kick, inverse_mass, force, v, begin, end, kicked);
  });
}

}  // namespace selvage::sim
#endif
