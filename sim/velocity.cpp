#include "sim/velocity.h"

#include <algorithm>

#include "sim/parallel.h"

namespace selvage::sim {
namespace {

constexpr std::int32_t kMaxIterations = 200;

using Row = Eigen::RowVector3d;

/// Row i of B v. In plain numbers: most of the dynamics' time is spent here.
Row impulse_at(const VelocitySystem& system, const Positions& direction, const Positions& v, Eigen::Index i) {
  const double* const v_i = v.data() + 3 * i;
  const double vx = v_i[0], vy = v_i[1], vz = v_i[2];
  double x = 0, y = 0, z = 0;
  for (const SpringSystem::End& end : system.springs.ends_at(static_cast<VertexId>(i))) {
    const double* const v_j = v.data() + 3 * std::ptrdiff_t{end.other};
    const double* const n = direction.data() + 3 * std::ptrdiff_t{end.spring};
    const double rate = n[0] * (vx - v_j[0]) + n[1] * (vy - v_j[1]) + n[2] * (vz - v_j[2]);
    const double impulse = system.spring_coefficient[end.spring] * rate;
    x += impulse * n[0];
    y += impulse * n[1];
    z += impulse * n[2];
  }
  const Row sum(x, y, z);
  if (system.stabilizers == nullptr) return sum;
  return sum - system.stabilizers->force_at(v, static_cast<VertexId>(i), system.stabilizer_stiffness_share,
                                            system.stabilizer_damping_share);
}

/// The diagonal of B.
Row diagonal_at(const VelocitySystem& system, const Positions& direction, Eigen::Index i) {
  Row sum = Row::Zero();
  for (const SpringSystem::End& end : system.springs.ends_at(static_cast<VertexId>(i))) {
    sum += system.spring_coefficient[end.spring] * direction.row(end.spring).cwiseAbs2();
  }
  if (system.stabilizers != nullptr) {
    sum.array() += system.stabilizers->diagonal(static_cast<VertexId>(i), system.stabilizer_stiffness_share,
                                                system.stabilizer_damping_share);
  }
  return sum;
}

}  // namespace

void damping_impulses(const VelocitySystem& system, const Positions& direction, const Positions& v, Positions& result) {
  result.resize(v.rows(), 3);
  parallel_each(result.rows(), [&](Eigen::Index i) { result.row(i) = impulse_at(system, direction, v, i); });
}

// The guess, its impulses, the residual and the first step.
VelocitySolver::Sums VelocitySolver::begin(const VelocitySystem& system, const Positions& direction,
                                           const Positions& rhs, double dt_s, const Positions& fixed_v) {
  const Eigen::Index rows = rhs.rows();
  for (Positions* X : {&guess_, &impulses_, &residual_, &step_, &product_, &inverse_diagonal_}) X->resize(rows, 3);
  const double drag = 1 + dt_s * system.drag_1_s;
  parallel_each(rows, [&](Eigen::Index i) {
    guess_.row(i) = system.inverse_mass[static_cast<std::size_t>(i)] > 0 ? Row(rhs.row(i) / drag) : Row(fixed_v.row(i));
  });
  const double energy = parallel_sum(rows, partial_, [&](Eigen::Index i) {
    const double w = system.inverse_mass[static_cast<std::size_t>(i)];
    impulses_.row(i) = impulse_at(system, direction, guess_, i);
    if (w > 0) {
      const Row diagonal = diagonal_at(system, direction, i).array() + drag / w;
      inverse_diagonal_.row(i) = diagonal.cwiseInverse();
      residual_.row(i) = -impulses_.row(i);
    } else {
      inverse_diagonal_.row(i).setZero();
      residual_.row(i).setZero();
    }
    step_.row(i) = residual_.row(i).cwiseProduct(inverse_diagonal_.row(i));
    return residual_.row(i).dot(step_.row(i));
  });
  const double momentum = parallel_sum(rows, partial_, [&](Eigen::Index i) {
    const double w = system.inverse_mass[static_cast<std::size_t>(i)];
    return w > 0 ? rhs.row(i).cwiseAbs2().dot(inverse_diagonal_.row(i)) / (w * w) : 0;
  });
  return {energy, kVelocityResidual * kVelocityResidual * std::min(energy, momentum)};
}

std::int32_t VelocitySolver::solve(const VelocitySystem& system, const Positions& direction, const Positions& rhs,
                                   double dt_s, Positions& v) {
  auto [energy, limit] = begin(system, direction, rhs, dt_s, v);
  const double drag = 1 + dt_s * system.drag_1_s;
  std::int32_t iteration = 0;
  // Written so that NaN ends the loop: the caller finds it in the velocity.
  while (iteration < kMaxIterations && energy > limit) {
    const double curvature = parallel_sum(rhs.rows(), partial_, [&](Eigen::Index i) {
      const double w = system.inverse_mass[static_cast<std::size_t>(i)];
      product_.row(i) = impulse_at(system, direction, step_, i);
      return w > 0 ? step_.row(i).dot(product_.row(i)) + drag / w * step_.row(i).squaredNorm() : 0;
    });
    const double along = energy / curvature;
    const double next = parallel_sum(rhs.rows(), partial_, [&](Eigen::Index i) {
      const double w = system.inverse_mass[static_cast<std::size_t>(i)];
      impulses_.row(i) += along * product_.row(i);
      if (w > 0) residual_.row(i) -= along * (product_.row(i) + drag / w * step_.row(i));
      return residual_.row(i).cwiseAbs2().dot(inverse_diagonal_.row(i));
    });
    const double turn = next / energy;
    parallel_each(rhs.rows(), [&](Eigen::Index i) {
      step_.row(i) = residual_.row(i).cwiseProduct(inverse_diagonal_.row(i)) + turn * step_.row(i);
    });
    energy = next;
    ++iteration;
  }
  parallel_each(rhs.rows(), [&](Eigen::Index i) {
    const double w = system.inverse_mass[static_cast<std::size_t>(i)];
    if (w > 0) v.row(i) = (rhs.row(i) - w * impulses_.row(i)) / drag;
  });
  return iteration;
}

}  // namespace selvage::sim
