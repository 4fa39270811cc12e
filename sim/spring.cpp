#include "sim/spring.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernel/assert.h"
#include "sim/parallel.h"

namespace selvage::sim {

SpringSystem::SpringSystem(std::vector<Spring> springs, std::int32_t vertex_count)
    : springs_(std::move(springs)), begin_(static_cast<std::size_t>(vertex_count) + 1) {
  for (const Spring& spring : springs_) {
    SELVAGE_ASSERT(spring.a != spring.b && std::min(spring.a, spring.b) >= 0 &&
                   std::max(spring.a, spring.b) < vertex_count);
    ++begin_[static_cast<std::size_t>(spring.a) + 1];
    ++begin_[static_cast<std::size_t>(spring.b) + 1];
  }
  for (std::size_t i = 1; i < begin_.size(); ++i) begin_[i] += begin_[i - 1];
  ends_.resize(2 * springs_.size());
  std::vector<std::size_t> next(begin_.begin(), begin_.end() - 1);
  for (std::uint32_t s = 0; s < springs_.size(); ++s) {
    ends_[next[static_cast<std::size_t>(springs_[s].a)]++] = {s, 1};
    ends_[next[static_cast<std::size_t>(springs_[s].b)]++] = {s, -1};
  }
}

void SpringSystem::elastic_forces(const PositionsRef& x, Positions& force) const {
  Positions pull(static_cast<Eigen::Index>(springs_.size()), 3);  // on end a; end b gets the opposite
  parallel_each(pull.rows(), [&](Eigen::Index s) {
    const Spring& spring = springs_[static_cast<std::size_t>(s)];
    const Eigen::RowVector3d d = x.row(spring.b) - x.row(spring.a);
    const double length = d.norm();
    const double factor = length > 0 ? spring.stiffness_n_m * (1 - spring.rest_length_m / length) : 0;
    pull.row(s) = factor * d;
  });
  force.resize(vertex_count(), 3);
  parallel_each(force.rows(), [&](Eigen::Index i) {
    Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
    for_each_at(static_cast<VertexId>(i), [&](std::uint32_t s, double sign) { sum += sign * pull.row(s); });
    force.row(i) = sum;
  });
}

void SpringSystem::directions(const PositionsRef& x, Positions& direction) const {
  direction.resize(static_cast<Eigen::Index>(springs_.size()), 3);
  parallel_each(direction.rows(), [&](Eigen::Index s) {
    const Spring& spring = springs_[static_cast<std::size_t>(s)];
    const Eigen::RowVector3d d = x.row(spring.b) - x.row(spring.a);
    const double length = d.norm();
    if (length > 0) {
      direction.row(s) = d / length;
    } else {
      direction.row(s).setZero();
    }
  });
}

void SpringSystem::apply(const Positions& direction, std::span<const double> coefficient, const Positions& v,
                         Positions& result, Positions& scratch) const {
  scratch.resize(direction.rows(), 3);
  parallel_each(direction.rows(), [&](Eigen::Index s) {
    const Spring& spring = springs_[static_cast<std::size_t>(s)];
    const double rate = direction.row(s).dot(v.row(spring.a) - v.row(spring.b));
    scratch.row(s) = (coefficient[static_cast<std::size_t>(s)] * rate) * direction.row(s);
  });
  result.resize(vertex_count(), 3);
  parallel_each(result.rows(), [&](Eigen::Index i) {
    Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
    for_each_at(static_cast<VertexId>(i), [&](std::uint32_t s, double sign) { sum += sign * scratch.row(s); });
    result.row(i) = sum;
  });
}

double stable_step_s(const SpringSystem& springs, std::span<const double> inverse_mass,
                     const StabilizerSystem& stabilizers) {
  double omega_squared_upper = 0;
  for (VertexId i = 0; i < springs.vertex_count(); ++i) {
    double stiffness = 0;
    springs.for_each_at(i, [&](std::uint32_t s, double) { stiffness += springs.springs()[s].stiffness_n_m; });
    omega_squared_upper = std::max(omega_squared_upper, inverse_mass[static_cast<std::size_t>(i)] *
                                                            (2 * stiffness + stabilizers.row_sum(i, 1, 0)));
  }
  return omega_squared_upper > 0 ? 2 / std::sqrt(omega_squared_upper) : std::numeric_limits<double>::infinity();
}

}  // namespace selvage::sim
