#include "sim/dynamics/contact_pack.h"

#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sim/dynamics/contact_pack.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "sim/contact/nearest_points-inl.h"
#include "sim/dynamics/pack_columns-inl.h"
#include "sim/response/friction_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace selvage::sim::HWY_NAMESPACE {

/// From the ends of a step of h seconds and the velocities in it to its start and the displacements.
void GoBack(double h, PackMotion& motion) {
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t first = 0; first < kLanes; first += VectorLanes()) {
      const Vector displacement = Scaled(Number(h), Read(motion.displacement[i], first));
      Write(Difference(Read(motion.x[i], first), displacement), first, motion.x[i]);
      Write(displacement, first, motion.displacement[i]);
    }
  }
}

/// How much of the approach in this step is too much; below 0 how much more there may be.
HWY_INLINE Value Excess(const ContactPack& pack, const PackMotion& motion, std::size_t first) {
  const Values weights = ReadFour(pack.weights, first);
  const Vector normal = Read(pack.normal, first);
  const Value moved = DotOf(Relative(weights, ReadFour(motion.displacement, first)), normal);
  const Value distance = hn::Add(DotOf(Relative(weights, ReadFour(motion.x, first)), normal), moved);
  const Value overlap = hn::Sub(Read(pack.thickness_m, first), distance);
  const Truth is_far =
      hn::And(hn::Eq(Read(pack.pressed, first), hn::Zero(Real())), hn::Not(hn::Gt(overlap, hn::Zero(Real()))));
  const Value approach = hn::Neg(moved);
  return hn::IfThenElse(hn::Or(is_far, hn::Lt(overlap, approach)), overlap, approach);
}

LaneMask NewlyPressed(const ContactPack& pack, const PackMotion& motion, LaneMask asked) {
  const Value zero = hn::Zero(Real());
  LaneMask result = 0;
  for (std::size_t first = 0; first < kLanes; first += VectorLanes()) {
    const Truth acts = hn::Or(hn::Gt(Read(pack.load_m_s2, first), zero), hn::Gt(Read(pack.pressed, first), zero));
    result |= LanesOf(hn::AndNot(acts, hn::Gt(Excess(pack, motion, first), zero)), first);
  }
  return result & asked;
}

void FindWorkFromOutside(const ContactPack& pack, const PackMotion& motion, LaneColumn<double>& result) {
  const Value zero = hn::Zero(Real());
  for (std::size_t first = 0; first < kLanes; first += VectorLanes()) {
    const Values weights = ReadFour(pack.weights, first), mobility = ReadFour(pack.mobility, first);
    const Vectors displacement = ReadFour(motion.displacement, first);
    const Value along = hn::Div(Read(pack.pressed, first), EffectiveMobility(weights, mobility));
    const Vector impulse = Sum(Scaled(along, Read(pack.normal, first)), Read(pack.rubbed, first));
    Value work = zero;
    for (std::size_t i = 0; i < 4; ++i) {
      const Value taken = hn::Mul(weights[i], DotOf(displacement[i], impulse));
      work = hn::Sub(work, hn::IfThenElseZero(hn::Eq(mobility[i], zero), taken));
    }
    Write(work, first, result);
  }
}

template <PairKind kKind>
void FindNearestOf(const PackMotion& motion, PackNearest& result) {
  result.on_border = 0;
  for (std::size_t first = 0; first < kLanes; first += VectorLanes()) {
    const Vectors x = ReadFour(motion.x, first);
    const auto nearest = Nearest<Real>::Of<kKind>(x.data());
    Write(nearest.distance, first, result.distance);
    Write(nearest.direction, first, result.direction);
    Write(nearest.first_weight, first, result.weights[0]);
    for (std::size_t k = 0; k < 3; ++k) {
      Write(nearest.weights.of[k], first, result.weights[k + 1]);
      result.on_border |= LanesOf(hn::Eq(nearest.weights.of[k], hn::Zero(Real())), first);
    }
  }
}
void FindNearest(PairKind kind, const PackMotion& motion, PackNearest& result) {
  kind == PairKind::kVf ? FindNearestOf<PairKind::kVf>(motion, result) : FindNearestOf<PairKind::kEe>(motion, result);
}

LaneMask TakeNearest(const PackNearest& nearest, LaneMask asked, ContactPack& pack) {
  const Value zero = hn::Zero(Real());
  LaneMask result = 0;
  for (std::size_t first = 0; first < kLanes; first += VectorLanes()) {
    const Truth which = TruthOf(asked, first);
    const Vector direction = Read(nearest.direction, first);
    const Truth is_far = hn::Gt(Read(nearest.distance, first), Read(pack.thickness_m, first));
    const Truth is_seen = hn::Or(is_far, hn::Gt(DotOf(direction, Read(pack.normal, first)), zero));
    const Values weights = ReadFour(nearest.weights, first);
    const Values mobility = ReadFour(pack.mobility, first);
    const Truth can_move = hn::Gt(EffectiveMobility(weights, mobility), zero);
    const Truth can_stay = hn::Gt(EffectiveMobility(ReadFour(pack.weights, first), mobility), zero);
    const Truth is_taken = hn::And(which, hn::And(is_seen, can_move));
    for (std::size_t i = 0; i < 4; ++i) WriteWhere(is_taken, weights[i], first, pack.weights[i]);
    WriteWhere(is_taken, direction, first, pack.normal);
    result |= LanesOf(hn::And(which, hn::Or(hn::And(is_seen, can_move), hn::AndNot(is_seen, can_stay))), first);
  }
  return result;
}

/// lever_share() of an Interaction.
HWY_INLINE Value LeverShare(const PairLanes& pair) {
  Value longest = hn::Zero(Real());
  for (std::size_t i = 0; i < 4; ++i) longest = hn::Max(longest, hn::Mul(hn::Abs(pair.weights[i]), pair.mobility[i]));
  const Value share = hn::Div(Number(kMaxLever), hn::Div(longest, pair.effective)), one = Number(1);
  return hn::IfThenElse(hn::Lt(share, one), hn::Mul(share, share), one);
}

/// Moves the vertices of cloth in the given lanes, which share none. Scalar: the rows of lanes are anywhere.
HWY_INLINE void MoveVertices(Truth which, const Vectors& changes, std::size_t first, const ContactPack& pack,
                             const ContactMotion& motion) {
  const Real d;
  const LaneMask moved = LanesOf(which, first);
  for (std::size_t i = 0; i < 4; ++i) {
    HWY_ALIGN double displaced[3][kLanes], quicker[3][kLanes];
    const Value* const axes[3] = {&changes[i].x, &changes[i].y, &changes[i].z};
    for (std::size_t k = 0; k < 3; ++k) {
      hn::Store(*axes[k], d, displaced[k]);
      hn::Store(hn::Div(*axes[k], Number(motion.h)), d, quicker[k]);
    }
    for (std::size_t lane = first; lane < first + VectorLanes(); ++lane) {
      const std::int32_t row = pack.vertices[i][lane];
      if (row < 0 || !has_lane(moved, lane)) continue;
      for (int k = 0; k < 3; ++k) {
        motion.x_t1.axis(k)[row] += displaced[k][lane - first];
        motion.v.axis(k)[row] += quicker[k][lane - first];
      }
    }
  }
}

/// Changes of the displacements that change the distance by `change`.
HWY_INLINE Vectors Push(Value change, const PairLanes& pair, const Vector& normal) {
  Vectors changes;
  for (std::size_t i = 0; i < 4; ++i) {
    const Value share = hn::Div(hn::Mul(pair.weights[i], pair.mobility[i]), pair.effective);
    changes[i] = Scaled(hn::Mul(change, share), normal);
  }
  return changes;
}

/// A friction that contacts begin a step with, before they are asked what slips: by the impulse that changes the
/// relative displacement of a pair that does not turn by `friction_m`, without what that has along the normal, as far
/// as the static cone of what has pressed allows. Adds to the changes, and sets what has rubbed.
HWY_INLINE void BeginFriction(Truth which, const SlipLanes& slip, const Vector& friction_m, Value pressed,
                              std::size_t first, ContactPack& pack, Vectors& changes) {
  const Value zero = hn::Zero(Real()), one = Number(1);
  const Vector normal = Read(pack.normal, first);
  const Vector across = Difference(friction_m, Scaled(DotOf(friction_m, normal), normal));
  Vector share{hn::Div(across.x, pressed), hn::Div(across.y, pressed), hn::Div(across.z, pressed)};
  const Value scale = PowerOfTwoAbove<Real>(LargestOf(share));
  const Vector scaled = Scaled(hn::Div(one, scale), share);
  const Value norm = hn::Mul(scale, hn::Sqrt(DotOf(scaled, scaled)));
  const Value most = Read(pack.friction_static, first);
  share = Scaled(hn::IfThenElse(hn::Gt(norm, most), hn::Div(most, norm), one), share);
  const Vector impulse = Scaled(hn::Div(one, slip.pair.effective), share);
  const Vectors unit = slip.ChangesBy(impulse);
  Value energy = zero;
  for (std::size_t i = 0; i < 4; ++i) {
    const Truth moves = hn::Gt(slip.pair.mobility[i], zero);
    energy = hn::Add(energy, hn::IfThenElseZero(moves, hn::Div(DotOf(unit[i], unit[i]), slip.pair.mobility[i])));
  }
  const Value bound = hn::Mul(hn::Mul(Number(1 + kFrictionRounding), slip.pair.effective), DotOf(impulse, impulse));
  const Truth rubs = hn::And(which, hn::And(hn::Gt(DotOf(share, share), zero), hn::Le(energy, bound)));
  for (std::size_t i = 0; i < 4; ++i) changes[i] = Sum(changes[i], Where(rubs, Scaled(pressed, unit[i])));
  WriteWhere(which, Where(rubs, Scaled(pressed, impulse)), first, pack.rubbed);
}

void BearLoads(const PackMotion& read, LaneMask asked, ContactPack& pack, const ContactMotion& motion) {
  const Value zero = hn::Zero(Real()), squared_s2 = Number(motion.h * motion.h);
  for (std::size_t first = 0; first < kLanes; first += VectorLanes()) {
    Truth which = TruthOf(asked, first);
    if (hn::AllFalse(Real(), which)) continue;
    const Vector normal = Read(pack.normal, first);
    const PairLanes pair(ReadFour(pack.weights, first), ReadFour(pack.mobility, first));
    which = hn::And(which, hn::Eq(LeverShare(pair), Number(1)));  // else it is pushed once, in the last sweep
    const Value pressed = hn::Mul(Read(pack.load_m_s2, first), squared_s2);
    WriteWhere(which, pressed, first, pack.pressed);
    Vectors changes = Push(pressed, pair, normal);
    const Vector friction_m = Scaled(squared_s2, Read(pack.friction_m_s2, first));
    const Truth rubs = hn::And(which, hn::And(hn::Gt(pressed, zero), hn::Gt(LargestOf(friction_m), zero)));
    if (!hn::AllFalse(Real(), rubs)) {
      const SlipLanes slip(pair, ReadFour(read.x, first), normal, rubs);
      BeginFriction(rubs, slip, friction_m, pressed, first, pack, changes);
    }
    MoveVertices(which, changes, first, pack, motion);
  }
}

/// friction_change(), after what was rubbed before has been taken back: adds to the changes.
HWY_INLINE void Rub(Truth which, const SlipLanes& slip, Value lever_share, const Vectors& read_displacement,
                    double creep_m, std::size_t first, ContactPack& pack, Vectors& changes) {
  const Value zero = hn::Zero(Real()), one = Number(1);
  const Value pressed = Read(pack.pressed, first);
  const Vector before = Read(pack.rubbed, first);
  const Vectors back = slip.ChangesBy(Scaled(Number(-1), before));
  const Truth had_begun = hn::And(which, hn::Gt(LargestOf(before), zero));
  Vectors displacement;
  Value largest = zero;
  for (std::size_t i = 0; i < 4; ++i) {
    changes[i] = Sum(changes[i], Where(had_begun, back[i]));
    displacement[i] = Sum(read_displacement[i], changes[i]);
    largest = hn::Max(largest, LargestOf(displacement[i]));
  }
  const Value scale = PowerOfTwoAbove<Real>(largest), down = hn::Div(one, scale);
  for (Vector& each : displacement) each = Scaled(down, each);
  const Vector to_stop = slip.ImpulseToStop(slip.SlipOf(displacement));
  const Value size = hn::Sqrt(DotOf(to_stop, to_stop));
  const Value normal_impulse = hn::Div(hn::Div(pressed, scale), slip.pair.effective);
  const Value most_static = hn::Mul(Read(pack.friction_static, first), normal_impulse);
  const Value most_kinetic = hn::Mul(Read(pack.friction_kinetic, first), normal_impulse);
  const Truth sticks = hn::Le(size, most_static);
  const Value slip_left = hn::Mul(hn::Mul(hn::Sub(size, most_kinetic), slip.pair.effective), scale);
  const Truth creeps = hn::Le(slip_left, Number(creep_m));
  const Value share = hn::IfThenElse(sticks, one, hn::Div(hn::IfThenElse(creeps, most_static, most_kinetic), size));
  const Vector impulse = Scaled(hn::Mul(lever_share, share), to_stop);
  const Vectors change = slip.ChangesBy(impulse);
  Truth rubs = hn::And(which, hn::And(hn::Gt(pressed, zero), hn::Gt(Read(pack.friction_static, first), zero)));
  rubs = hn::And(rubs, hn::And(hn::Gt(size, zero), hn::Gt(share, zero)));
  rubs = hn::AndNot(hn::And(slip.is_closed, AddsEnergy(slip, displacement, change)), rubs);
  for (std::size_t i = 0; i < 4; ++i) changes[i] = Sum(changes[i], Where(rubs, Scaled(scale, change[i])));
  WriteWhere(which, Where(rubs, Scaled(scale, impulse)), first, pack.rubbed);
}

void Press(const PackMotion& read, LaneMask asked, double relaxation, bool is_last, ContactPack& pack,
           const ContactMotion& motion) {
  const Value zero = hn::Zero(Real());
  for (std::size_t first = 0; first < kLanes; first += VectorLanes()) {
    Truth which = TruthOf(asked, first);
    if (hn::AllFalse(Real(), which)) continue;
    const Vector normal = Read(pack.normal, first);
    const Vectors displacement = ReadFour(read.displacement, first);
    const PairLanes pair(ReadFour(pack.weights, first), ReadFour(pack.mobility, first));
    const Value lever_share = LeverShare(pair);
    // A contact whose lever is limited acts once: its limits would add up.
    if (!is_last) which = hn::And(which, hn::Eq(lever_share, Number(1)));
    const Value excess = Excess(pack, read, first), before = Read(pack.pressed, first);
    const Value least = hn::Neg(before);
    const Value change = hn::Mul(lever_share, hn::IfThenElse(hn::Gt(excess, zero), hn::Mul(Number(relaxation), excess),
                                                             hn::IfThenElse(hn::Gt(excess, least), excess, least)));
    const Value pressed = hn::Add(before, change);
    WriteWhere(which, pressed, first, pack.pressed);
    Vectors changes = Push(change, pair, normal);
    if (is_last) {
      const Truth is_pressed = hn::And(which, hn::Gt(pressed, zero));
      const Truth has_rubbed = hn::And(which, hn::Gt(LargestOf(Read(pack.rubbed, first)), zero));
      const Truth rubs = hn::Or(has_rubbed, hn::And(is_pressed, hn::Gt(Read(pack.friction_static, first), zero)));
      if (!hn::AllFalse(Real(), rubs)) {
        const SlipLanes slip(pair, ReadFour(read.x, first), normal, rubs);
        Rub(rubs, slip, lever_share, displacement, motion.creep_m, first, pack, changes);
      }
      pack.ever_repelled |= LanesOf(is_pressed, first);
      pack.ever_rubbed |= LanesOf(hn::And(which, hn::Gt(LargestOf(Read(pack.rubbed, first)), zero)), first);
    }
    MoveVertices(which, changes, first, pack, motion);
  }
}

/// Friction is learnt where the vertex can move: cloth that the edge of a box carried by a vertex of its own swung
/// about that by 0.7 mm for ever, and rests since the vertices of bodies do not remember
/// (docs/measurements/simulator-speed.md). Edges learn where all four of their vertices can.
void LearnLoads(PairKind kind, double learnt, double h, ContactPack& pack) {
  const Value zero = hn::Zero(Real()), one = Number(1), learning = Number(learnt);
  const Value squared_s2 = Number(h * h), largest = Number(std::numeric_limits<double>::max());
  for (std::size_t first = 0; first < kLanes; first += VectorLanes()) {
    const PairLanes pair(ReadFour(pack.weights, first), ReadFour(pack.mobility, first));
    const Value pressed = Read(pack.pressed, first);
    const Truth is_whole = hn::Eq(LeverShare(pair), one);
    Truth learns = hn::And(hn::Gt(pressed, zero), is_whole);
    if (kind == PairKind::kEe) {
      for (const Value& mobility : pair.mobility) learns = hn::And(learns, hn::Gt(mobility, zero));
    }
    const Value in_step = hn::Div(pressed, squared_s2);
    const Value now = hn::IfThenElse(hn::Gt(in_step, largest), largest, in_step);
    const Value load = Read(pack.load_m_s2, first);
    const Value next = hn::Add(load, hn::Mul(learning, hn::Sub(now, load)));
    const Vector friction = Scaled(hn::Div(pair.effective, squared_s2), Read(pack.rubbed, first));
    const Vector size = lanes::Absolute<Real>(friction);
    const Truth is_finite = hn::And(hn::Le(size.x, largest), hn::And(hn::Le(size.y, largest), hn::Le(size.z, largest)));
    const Vector found = Where(hn::And(is_finite, hn::Gt(pair.mobility[0], zero)), friction);
    const Vector kept = Scaled(hn::Sub(one, learning), Read(pack.friction_m_s2, first));
    Write(hn::IfThenElseZero(learns, next), first, pack.load_m_s2);
    Write(Where(learns, Sum(kept, Scaled(learning, found))), first, pack.friction_m_s2);
  }
}

}  // namespace selvage::sim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace selvage::sim {

namespace {

/// The axes of vectors, at hand.
std::array<const double*, 3> axes_of(const LaneVectors& vectors) {
  return {vectors.axis(0), vectors.axis(1), vectors.axis(2)};
}

}  // namespace

void set_load(double along_m_s2, const Vec3& friction_m_s2, std::size_t lane, ContactPack& pack) {
  pack.load_m_s2[lane] = along_m_s2;
  for (std::size_t k = 0; k < 3; ++k) pack.friction_m_s2[k][lane] = friction_m_s2[static_cast<Eigen::Index>(k)];
}

void see_anew(const PackNearest& nearest, LaneMask lanes, ContactPack& pack) {
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    if (!has_lane(lanes, lane)) continue;
    for (std::size_t k = 0; k < 3; ++k) pack.normal[k][lane] = nearest.direction[k][lane];
  }
}

LaneMask above_zero(const LaneColumn<double>& column) {
  LaneMask result = 0;
  for (std::size_t lane = 0; lane < kLanes; ++lane)
    result |= static_cast<LaneMask>((column[lane] > 0 ? 1U : 0U) << lane);
  return result;
}

LaneMask that_take(std::int32_t sweeps, const ContactPack& pack) {
  LaneMask result = 0;
  for (std::size_t lane = 0; lane < kLanes; ++lane)
    result |= pack.sweeps[lane] >= sweeps ? only_lane(lane) : LaneMask{0};
  return result;
}

namespace {

/// The ends of the step and the velocities, as if all vertices were of cloth; zero where one is not, or is not asked
/// for. One by one: the rows of lanes are anywhere, and gathering eight of them at once was no faster (AMD EPYC with
/// AVX-512, sim/scenes/curtain.toml at full quality). Whether any is not of cloth.
bool copy_rows(const ContactPack& pack, LaneMask lanes, const ContactMotion& motion, PackMotion& result) {
  constexpr std::ptrdiff_t kZeroRow = -1;  // before the first
  const auto end = axes_of(motion.x_t1), v = axes_of(motion.v);
  bool any_scripted = false;
  for (std::size_t i = 0; i < 4; ++i) {
    auto& [x, y, z] = result.x[i];
    auto& [v_x, v_y, v_z] = result.displacement[i];
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const std::ptrdiff_t vertex = has_lane(lanes, lane) ? pack.vertices[i][lane] : 0;
      any_scripted = any_scripted || vertex < 0;
      const std::ptrdiff_t row = has_lane(lanes, lane) && vertex >= 0 ? vertex : kZeroRow;
      x[lane] = end[0][row];
      y[lane] = end[1][row];
      z[lane] = end[2][row];
      v_x[lane] = v[0][row];
      v_y[lane] = v[1][row];
      v_z[lane] = v[2][row];
    }
  }
  return any_scripted;
}

void read_scripted(const ContactPack& pack, LaneMask lanes, const ContactMotion& motion, PackMotion& result) {
  const auto start = axes_of(motion.scripted_x), way = axes_of(motion.scripted_way);
  const double share = motion.share, step_share = motion.step_share;
  const bool has_bow = motion.scripted_bow != nullptr;
  const auto bow = has_bow ? axes_of(*motion.scripted_bow) : way;
  const double bent = has_bow ? share * (1 - share) : 0;
  const double bends = has_bow ? step_share * (1 - 2 * share - step_share) : 0;
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const std::ptrdiff_t row = ~pack.vertices[i][lane];
      if (!has_lane(lanes, lane) || row < 0) continue;
      for (std::size_t k = 0; k < 3; ++k) {
        result.displacement[i][k][lane] = step_share * way[k][row] - bends * bow[k][row];
        result.x[i][k][lane] = start[k][row] + share * way[k][row] - bent * bow[k][row];
      }
    }
  }
}

}  // namespace

HWY_EXPORT(GoBack);
HWY_EXPORT(NewlyPressed);
HWY_EXPORT(FindWorkFromOutside);
HWY_EXPORT(FindNearest);
HWY_EXPORT(TakeNearest);
HWY_EXPORT(BearLoads);
HWY_EXPORT(Press);
HWY_EXPORT(LearnLoads);

void read_motion(const ContactPack& pack, LaneMask lanes, const ContactMotion& motion, PackMotion& result) {
  result.lanes = lanes;
  const bool any_scripted = copy_rows(pack, lanes, motion, result);
  HWY_DYNAMIC_DISPATCH(GoBack)(motion.h, result);
  if (any_scripted) read_scripted(pack, lanes, motion, result);
}
LaneMask newly_pressed(const ContactPack& pack, const PackMotion& motion, LaneMask lanes) {
  return HWY_DYNAMIC_DISPATCH(NewlyPressed)(pack, motion, lanes);
}
void find_work_from_outside(const ContactPack& pack, const PackMotion& motion, LaneColumn<double>& result) {
  HWY_DYNAMIC_DISPATCH(FindWorkFromOutside)(pack, motion, result);
}
void find_nearest(PairKind kind, const PackMotion& motion, PackNearest& result) {
  HWY_DYNAMIC_DISPATCH(FindNearest)(kind, motion, result);
}
LaneMask take_nearest(const PackNearest& nearest, LaneMask lanes, ContactPack& pack) {
  return HWY_DYNAMIC_DISPATCH(TakeNearest)(nearest, lanes, pack);
}
void bear_loads(const PackMotion& read, LaneMask lanes, ContactPack& pack, const ContactMotion& motion) {
  HWY_DYNAMIC_DISPATCH(BearLoads)(read, lanes, pack, motion);
}
void press(const PackMotion& read, LaneMask lanes, double relaxation, bool is_last, ContactPack& pack,
           const ContactMotion& motion) {
  HWY_DYNAMIC_DISPATCH(Press)(read, lanes, relaxation, is_last, pack, motion);
}
void learn_loads(PairKind kind, double share, double h, ContactPack& pack) {
  HWY_DYNAMIC_DISPATCH(LearnLoads)(kind, share, h, pack);
}

}  // namespace selvage::sim
#endif
