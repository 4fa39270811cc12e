#include "sim/dynamics/velocity.h"

#include <algorithm>

#include "sim/base/parallel.h"

namespace selvage::sim {
namespace {

constexpr std::int32_t kMaxIterations = 200;

using Row = Eigen::RowVector3d;

}  // namespace

VelocitySolver::Norms& VelocitySolver::Norms::operator+=(const Norms& other) {
  residual += other.residual;
  impulses += other.impulses;
  momentum += other.momentum;
  return *this;
}

// v becomes the first guess, impulses its own; then the residual and the first step.
VelocitySolver::Norms VelocitySolver::begin(const VelocitySystem& system, const LaneVectors& rhs, double dt_s,
                                            LaneVectors& impulses, LaneVectors& v) {
  const Eigen::Index rows = rhs.rows();
  for (LaneVectors* X : {&residual_, &step_, &product_, &inverse_diagonal_, &impulses}) X->resize(rows);
  const double drag = 1 + dt_s * system.drag_1_s;
  parallel_each(rows, [&](Eigen::Index i) {
    const double w = system.inverse_mass[static_cast<std::size_t>(i)];
    if (w > 0) v.row(i) = (rhs.row(i) - w * impulses.row(i)) / drag;
  });
  system.springs.begin_product(v);
  return parallel_sum(rows, partial_norms_, [&](Eigen::Index first, Eigen::Index end) {
    Norms norms;
    system.springs.multiply_rows(system.x, v, first, end, product_);
    for (Eigen::Index i = first; i < end; ++i) {
      const double w = system.inverse_mass[static_cast<std::size_t>(i)];
      Row inverse_diagonal = Row::Zero();
      if (w > 0) inverse_diagonal = (system.springs.diagonal().row(i).array() + drag / w).inverse();
      const Row product = product_.row(i), residual = impulses.row(i) - product;
      inverse_diagonal_.row(i) = inverse_diagonal;
      residual_.row(i) = residual;
      impulses.row(i) = product;
      step_.row(i) = residual.cwiseProduct(inverse_diagonal);
      norms.residual += residual.cwiseAbs2().dot(inverse_diagonal);
      norms.impulses += product.cwiseAbs2().dot(inverse_diagonal);
      if (w > 0) norms.momentum += rhs.row(i).cwiseAbs2().dot(inverse_diagonal) / (w * w);
    }
    return norms;
  });
}

std::int32_t VelocitySolver::solve(const VelocitySystem& system, const LaneVectors& rhs, double dt_s,
                                   LaneVectors& impulses, LaneVectors& v) {
  const Norms norms = begin(system, rhs, dt_s, impulses, v);
  double energy = norms.residual;
  const double limit = kVelocityResidual * kVelocityResidual * std::min(norms.impulses, norms.momentum);
  const double drag = 1 + dt_s * system.drag_1_s;
  std::int32_t iteration = 0;
  // Written so that NaN ends the loop: the caller finds it in the velocity.
  while (iteration < kMaxIterations && energy > limit) {
    system.springs.begin_correction(step_);
    const double curvature = parallel_sum(rhs.rows(), partial_, [&](Eigen::Index first, Eigen::Index end) {
      double sum = 0;
      system.springs.multiply_rows(system.x, step_, first, end, product_);
      for (Eigen::Index i = first; i < end; ++i) {
        const double w = system.inverse_mass[static_cast<std::size_t>(i)];
        const Row step = step_.row(i);
        if (w > 0) sum += step.dot(product_.row(i)) + drag / w * step.squaredNorm();
      }
      return sum;
    });
    const double along = energy / curvature;
    const double next = parallel_sum(rhs.rows(), partial_, [&](Eigen::Index first, Eigen::Index end) {
      double sum = 0;
      for (Eigen::Index i = first; i < end; ++i) {
        const double w = system.inverse_mass[static_cast<std::size_t>(i)];
        const Row product = product_.row(i);
        impulses.row(i) += along * product;
        if (w == 0) continue;
        const Row residual = residual_.row(i) - along * (product + drag / w * step_.row(i));
        residual_.row(i) = residual;
        sum += residual.cwiseAbs2().dot(inverse_diagonal_.row(i));
      }
      return sum;
    });
    const double turn = next / energy;
    energy = next;
    ++iteration;
    if (!(energy > limit)) break;
    parallel_each(rhs.rows(), [&](Eigen::Index i) {
      step_.row(i) = residual_.row(i).cwiseProduct(inverse_diagonal_.row(i)) + turn * step_.row(i);
    });
  }
  parallel_each(rhs.rows(), [&](Eigen::Index i) {
    const double w = system.inverse_mass[static_cast<std::size_t>(i)];
    if (w > 0) v.row(i) = (rhs.row(i) - w * impulses.row(i)) / drag;
  });
  return iteration;
}

}  // namespace selvage::sim
