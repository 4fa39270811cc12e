#include "sim/response/step_motion.h"

#include <algorithm>
#include <limits>

#include "kernel/assert.h"

namespace selvage::sim {

void StepMotion::start(const PositionsRef& V_t0, const PositionsRef& V_t1, Precision precision) {
  V_t0_ = V_t0;
  const double limit = to_lattice(std::numeric_limits<double>::max(), precision);
  displacement_ = V_t1.cwiseMax(-limit).cwiseMin(limit) - V_t0;
  precision_ = precision;
  x_ = to_lattice(V_t1, precision);
  changed_.assign(static_cast<std::size_t>(V_t0.rows()), 0);
  anything_changed_ = false;
}

void StepMotion::move(VertexId vertex, const Vec3& displacement) {
  SELVAGE_ASSERT(displacement.allFinite());
  const Vec3 start = V_t0_.row(vertex);
  const Vec3 end = start + displacement;
  const Vec3 stored = end.unaryExpr([this](double value) { return to_lattice(value, precision_); });
  displacement_.row(vertex) = displacement;
  for (int axis = 0; axis < 3; ++axis) {
    const double limit = to_lattice(std::numeric_limits<double>::max(), precision_);
    if (std::abs(end[axis]) > limit) displacement_(vertex, axis) = stored[axis] - start[axis];
  }
  store(vertex, stored);
}

void StepMotion::freeze(VertexId vertex) {
  displacement_.row(vertex).setZero();
  store(vertex, V_t0_.row(vertex));
}

void StepMotion::store(VertexId vertex, const Vec3& x) {
  if (x_.row(vertex).transpose() == x) return;
  x_.row(vertex) = x;
  changed_[static_cast<std::size_t>(vertex)] = 1;
  anything_changed_ = true;
}

std::vector<std::uint8_t> StepMotion::take_changed() {
  std::vector<std::uint8_t> taken(changed_.size(), 0);
  taken.swap(changed_);
  anything_changed_ = false;
  return taken;
}

}  // namespace selvage::sim
