#include "sim/springs/impulse_projection.h"

#include <algorithm>
#include <cmath>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sim/springs/impulse_projection.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "sim/base/lane_sum-inl.h"
#include "sim/base/lane_table-inl.h"

HWY_BEFORE_NAMESPACE();
namespace selvage::sim::HWY_NAMESPACE {

HWY_INLINE void WriteAt(Value value, std::vector<double>& column, std::size_t row) {
  hn::StoreU(value, Real(), column.data() + row);
}
/// Zero where it is not a number.
HWY_INLINE Value NotBelowZero(Value value) { return hn::IfThenElseZero(hn::Gt(value, hn::Zero(Real())), value); }

/// From the impulses of the direction at the vertices.
ProjectionCurve LookAlong(const double* impulse_at, double added, ProjectionColumns& columns) {
  const Real d;
  const Value zero = hn::Zero(d), compliance = hn::Set(d, added);
  const Value endless = hn::Set(d, std::numeric_limits<double>::infinity());
  const Axes impulse(impulse_at, impulse_at + 1, impulse_at + 2);
  LaneSum slope, curvature;
  Value feasible = endless;
  for (std::size_t row = 0; row < columns.q.size(); row += hn::Lanes(d)) {
    const Vector at_a = GatherRows(impulse, columns.a.data() + row), at_b = GatherRows(impulse, columns.b.data() + row);
    const Vector rate = lanes::Minus<Real>(lanes::Times<Real>(ReadEntries(columns.inverse_mass_a, row), at_a),
                                           lanes::Times<Real>(ReadEntries(columns.inverse_mass_b, row), at_b));
    const Vector line{ReadEntries(columns.x, row), ReadEntries(columns.y, row), ReadEntries(columns.z, row)};
    const Value direction = ReadEntries(columns.direction, row);
    const Value product = hn::Add(lanes::Dot<Real>(line, rate), hn::Mul(compliance, direction));
    WriteAt(product, columns.product, row);
    const auto at = static_cast<Eigen::Index>(row);
    slope.Add(at, hn::Mul(ReadEntries(columns.gradient, row), direction));
    curvature.Add(at, hn::Mul(direction, product));
    const Value until = hn::Div(hn::Neg(ReadEntries(columns.q, row)), direction);
    feasible = hn::Min(feasible, hn::IfThenElse(hn::Lt(direction, zero), until, endless));
  }
  return {slope.total(), curvature.total(), hn::GetLane(hn::MinOfLanes(d, feasible))};
}

ProjectionLeft GoAlong(double length, double inverse_step, ProjectionColumns& columns) {
  const Real d;
  const Value zero = hn::Zero(d), far = hn::Set(d, length), by_step = hn::Set(d, inverse_step);
  LaneSum acting, missing, turned;
  for (std::size_t row = 0; row < columns.q.size(); row += hn::Lanes(d)) {
    const Value product = ReadEntries(columns.product, row);
    const Value q =
        NotBelowZero(hn::Add(ReadEntries(columns.q, row), hn::Mul(far, ReadEntries(columns.direction, row))));
    const Value gradient = hn::Add(ReadEntries(columns.gradient, row), hn::Mul(far, product));
    WriteAt(q, columns.q, row);
    WriteAt(gradient, columns.gradient, row);
    const auto acts = hn::Gt(q, zero), lacks = hn::AndNot(acts, hn::Lt(gradient, zero));
    const Value shrinks = hn::Min(hn::Mul(q, by_step), gradient);
    const auto at = static_cast<Eigen::Index>(row);
    acting.Add(at, hn::IfThenElseZero(acts, hn::Mul(shrinks, gradient)));
    missing.Add(at, hn::IfThenElseZero(lacks, hn::Mul(gradient, gradient)));
    turned.Add(at, hn::IfThenElseZero(acts, hn::Mul(gradient, product)));
  }
  return {acting.total(), missing.total(), turned.total()};
}

/// Down the gradient where impulses act, and `share` of the last direction.
void TurnDirection(double share, ProjectionColumns& columns) {
  const Real d;
  const Value zero = hn::Zero(d), last = hn::Set(d, share);
  for (std::size_t row = 0; row < columns.q.size(); row += hn::Lanes(d)) {
    const auto acts = hn::Gt(ReadEntries(columns.q, row), zero);
    const Value down = hn::IfThenElseZero(acts, hn::Neg(ReadEntries(columns.gradient, row)));
    WriteAt(hn::Add(down, hn::Mul(last, ReadEntries(columns.direction, row))), columns.direction, row);
  }
}

/// As far as no impulse pulls.
void ProjectGradient(double step, ProjectionColumns& columns) {
  const Real d;
  const Value zero = hn::Zero(d), far = hn::Set(d, step);
  for (std::size_t row = 0; row < columns.q.size(); row += hn::Lanes(d)) {
    const Value q = ReadEntries(columns.q, row);
    const Value moved = NotBelowZero(hn::Sub(q, hn::Mul(far, ReadEntries(columns.gradient, row))));
    WriteAt(hn::Sub(hn::IfThenElseZero(hn::Gt(q, zero), moved), q), columns.direction, row);
  }
}

/// Down the gradient of those that have none.
void AddMissing(ProjectionColumns& columns) {
  const Real d;
  const Value zero = hn::Zero(d);
  for (std::size_t row = 0; row < columns.q.size(); row += hn::Lanes(d)) {
    const Value down = NotBelowZero(hn::Neg(ReadEntries(columns.gradient, row)));
    WriteAt(hn::IfThenElse(hn::Gt(ReadEntries(columns.q, row), zero), zero, down), columns.direction, row);
  }
}

}  // namespace selvage::sim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace selvage::sim {
namespace {

/// Of what is left to improve, over that without any impulse. docs/measurements/numerics.md (*Limits on strain*) says
/// what it leaves.
constexpr double kTolerance = 0.02;

/// Added to the scaled system's diagonal: where bounds cannot all be kept, as between two pins that part, impulses
/// would grow without end. A cloth of 150 springs that hangs at its limit in steps of 0.4 ms gives way by 150 g 0.4 ms
/// times this, 0.06 mm/s a spring.
constexpr double kCompliance = 1e-4;

/// Doubles from one vertex to the next in impulse_at_.
constexpr std::int32_t kStride = 4;

}  // namespace

HWY_EXPORT(LookAlong);
HWY_EXPORT(GoAlong);
HWY_EXPORT(TurnDirection);
HWY_EXPORT(ProjectGradient);
HWY_EXPORT(AddMissing);

ImpulseProjection::ImpulseProjection(std::int32_t vertex_count)
    : row_vertex_(static_cast<std::size_t>(vertex_count), -1) {}

std::int32_t ImpulseProjection::row_vertex(VertexId vertex) {
  std::int32_t& id = row_vertex_[static_cast<std::size_t>(vertex)];
  if (id < 0) {
    id = static_cast<std::int32_t>(vertices_.size());
    vertices_.push_back(vertex);
  }
  return id;
}

// In units of the fastest, so that no square leaves the range of doubles. The largest eigenvalue is at most the largest
// number of pairs at a vertex that can move: q^T A q is the sum over the vertices of w |sum of q_i n_i|^2 <= w n sum of
// q_i^2, and each q_i^2 (w_a + w_b) is in it once.
void ImpulseProjection::set_rows(const std::vector<BoundedPair>& pairs, double fastest) {
  const std::size_t lanes = kLanes, rows = (pairs.size() + lanes - 1) / lanes * lanes;
  ProjectionColumns& c = columns_;
  for (auto* column : {&c.a, &c.b}) column->assign(rows, 0);
  for (auto* column :
       {&c.inverse_mass_a, &c.inverse_mass_b, &c.x, &c.y, &c.z, &c.q, &c.gradient, &c.direction, &c.product}) {
    column->assign(rows, 0);
  }
  scale_.clear();
  directions_.clear();
  vertices_.clear();
  scale_.reserve(pairs.size());  // nothing throws before row_vertex_ is as it was
  directions_.reserve(pairs.size());
  vertices_.reserve(2 * pairs.size());
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const BoundedPair& pair = pairs[i];
    const double scale = 1 / std::sqrt(pair.inverse_mass_a + pair.inverse_mass_b);
    const Vec3 direction = scale * pair.direction;
    scale_.push_back(scale);
    directions_.emplace_back(direction.x(), direction.y(), direction.z(), 0);
    c.a[i] = kStride * row_vertex(pair.a);
    c.b[i] = kStride * row_vertex(pair.b);
    c.inverse_mass_a[i] = pair.inverse_mass_a;
    c.inverse_mass_b[i] = pair.inverse_mass_b;
    c.x[i] = direction.x();
    c.y[i] = direction.y();
    c.z[i] = direction.z();
    c.direction[i] = pair.impulse_n_s / scale / fastest;
    c.gradient[i] = -pair.excess_m_s * scale / fastest;
  }
  for (const VertexId vertex : vertices_) row_vertex_[static_cast<std::size_t>(vertex)] = -1;
  impulse_at_.resize(vertices_.size());
  std::vector<std::int32_t> count(vertices_.size());
  std::int32_t most = 1;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (c.inverse_mass_a[i] > 0) most = std::max(most, ++count[static_cast<std::size_t>(c.a[i] / kStride)]);
    if (c.inverse_mass_b[i] > 0) most = std::max(most, ++count[static_cast<std::size_t>(c.b[i] / kStride)]);
  }
  inverse_step_ = most + kCompliance;
}

ProjectionCurve ImpulseProjection::look_along() {
  std::ranges::fill(impulse_at_, Eigen::Vector4d::Zero());
  for (std::size_t i = 0; i < directions_.size(); ++i) {
    const Eigen::Vector4d impulse = columns_.direction[i] * directions_[i];
    impulse_at_[static_cast<std::size_t>(columns_.a[i] / kStride)] += impulse;
    impulse_at_[static_cast<std::size_t>(columns_.b[i] / kStride)] -= impulse;
  }
  return HWY_DYNAMIC_DISPATCH(LookAlong)(impulse_at_.front().data(), kCompliance, columns_);
}

void ImpulseProjection::go_along(double length) {
  left_ = HWY_DYNAMIC_DISPATCH(GoAlong)(length, inverse_step_, columns_);
}

/// From where none acts to `direction`, or to the least on the way there.
void ImpulseProjection::take_guess() {
  const ProjectionCurve curve = look_along();
  go_along(curve.curvature > 0 ? std::clamp(-curve.slope / curve.curvature, 0.0, 1.0) : 0);
}

void ImpulseProjection::add_missing() {
  HWY_DYNAMIC_DISPATCH(AddMissing)(columns_);
  const ProjectionCurve curve = look_along();
  go_along(-curve.slope / curve.curvature);
  is_new_face_ = true;
}

/// A step of conjugate gradients; where one would pull, as far as that lets it, then down the gradient.
void ImpulseProjection::improve_acting() {
  if (is_new_face_) HWY_DYNAMIC_DISPATCH(TurnDirection)(0, columns_);
  is_new_face_ = false;
  const ProjectionCurve curve = look_along();
  const double length = -curve.slope / curve.curvature;
  go_along(std::min(length, curve.feasible));
  if (length > curve.feasible) return project_gradient();
  HWY_DYNAMIC_DISPATCH(TurnDirection)(left_.turned / curve.curvature, columns_);
}

void ImpulseProjection::project_gradient() {
  HWY_DYNAMIC_DISPATCH(ProjectGradient)(1 / inverse_step_, columns_);
  look_along();
  go_along(1);
  is_new_face_ = true;
}

void ImpulseProjection::solve(std::vector<BoundedPair>& pairs, Start start, std::int32_t iterations) {
  double fastest = 0;
  bool is_finite = true;
  for (BoundedPair& pair : pairs) {
    pair.change_n_s = 0;
    fastest = std::max(fastest, std::abs(pair.excess_m_s));
    is_finite = is_finite && std::isfinite(pair.excess_m_s);
  }
  if (!is_finite || fastest == 0) {
    for (BoundedPair& pair : pairs) pair.impulse_n_s = start == Start::kActing ? pair.impulse_n_s : 0;
    return;
  }
  set_rows(pairs, fastest);
  if (start == Start::kGuess) {
    go_along(0);
    first_m_s_ = std::sqrt(left_.missing) * fastest;
    take_guess();
  } else {
    // None moves; to the gradient comes what their compliance adds.
    columns_.product = columns_.q = columns_.direction;
    columns_.direction.assign(columns_.direction.size(), 0);
    go_along(kCompliance);
  }
  is_new_face_ = true;
  const double enough = kTolerance * first_m_s_ / fastest;
  for (std::int32_t iteration = 0; iteration < iterations; ++iteration) {
    if (!(left_.acting + left_.missing > enough * enough)) break;
    if (left_.missing > left_.acting) {
      add_missing();
    } else {
      improve_acting();
    }
  }
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const double impulse_n_s = columns_.q[i] * scale_[i] * fastest;
    pairs[i].change_n_s = impulse_n_s - (start == Start::kActing ? pairs[i].impulse_n_s : 0);
    pairs[i].impulse_n_s = impulse_n_s;
  }
}

}  // namespace selvage::sim
#endif
