#include "sim/central_differences.h"

#include <cmath>

#include "kernel/assert.h"
#include "sim/parallel.h"
#include "sim/velocity.h"

namespace selvage::sim {

CentralDifferences::CentralDifferences(const SpringSystem& springs, const CentralDifferencesOptions& options)
    : springs_(springs), options_(options), half_step_damping_(springs.springs().size()) {
  SELVAGE_ASSERT(options.step_s > 0);
  for (const Spring& spring : springs.springs()) damping_.push_back(spring.damping_n_s_m);
}

void CentralDifferences::find_forces(const Positions& x) {
  springs_.elastic_forces(x, force_);
  springs_.directions(x, direction_);
}

void CentralDifferences::explicit_half_kick(Motion& motion, std::span<const double> inverse_mass, double h) {
  springs_.apply(direction_, damping_, motion.v, damping_force_, scratch_);
  parallel_each(motion.v.rows(), [&](Eigen::Index i) {
    const double w = inverse_mass[static_cast<std::size_t>(i)];
    if (w == 0) return;
    motion.v.row(i) += h / 2 *
                       (options_.gravity_m_s2.transpose() - options_.drag_1_s * motion.v.row(i) +
                        w * (force_.row(i) - damping_force_.row(i)));
  });
}

void CentralDifferences::implicit_half_kick(Motion& motion, std::span<const double> inverse_mass, double h,
                                            double stiffness_share) {
  for (std::size_t s = 0; s < damping_.size(); ++s) {
    half_step_damping_[s] =
        h / 2 * damping_[s] + stiffness_share * (h / 2) * (h / 2) * springs_.springs()[s].stiffness_n_m;
  }
  Positions rhs = motion.v;
  parallel_each(rhs.rows(), [&](Eigen::Index i) {
    const double w = inverse_mass[static_cast<std::size_t>(i)];
    if (w > 0) rhs.row(i) += h / 2 * (options_.gravity_m_s2.transpose() + w * force_.row(i));
  });
  solve_velocity({springs_, inverse_mass, options_.drag_1_s, half_step_damping_}, direction_, rhs, h / 2, motion.v);
}

void CentralDifferences::advance(Motion& motion, const PositionsRef& scripted_x_t1,
                                 std::span<const double> inverse_mass, double dt_s) {
  const int step_count = static_cast<int>(std::ceil(dt_s / options_.step_s));
  const double h = dt_s / step_count;
  for (Eigen::Index i = 0; i < motion.x.rows(); ++i) {
    if (inverse_mass[static_cast<std::size_t>(i)] == 0) {
      motion.v.row(i) = (scripted_x_t1.row(i) - motion.x.row(i)) / dt_s;
    }
  }
  find_forces(motion.x);
  for (int step = 0; step < step_count; ++step) {
    explicit_half_kick(motion, inverse_mass, h);
    limit_strain(springs_, inverse_mass, motion.x, h, options_.strain, motion.v);
    limit_strain_rate(springs_, inverse_mass, motion.x, h, options_.strain, motion.v);
    motion.x += h * motion.v;
    find_forces(motion.x);
    implicit_half_kick(motion, inverse_mass, h, 0);
  }
  for (Eigen::Index i = 0; i < motion.x.rows(); ++i) {
    if (inverse_mass[static_cast<std::size_t>(i)] == 0) motion.x.row(i) = scripted_x_t1.row(i);
  }
}

void CentralDifferences::final_velocity(Motion& motion, std::span<const double> inverse_mass, double dt_s) {
  find_forces(motion.x);
  implicit_half_kick(motion, inverse_mass, dt_s, 1);
  limit_strain_rate(springs_, inverse_mass, motion.x, dt_s, options_.strain, motion.v);
}

}  // namespace selvage::sim
