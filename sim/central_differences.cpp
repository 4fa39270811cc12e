#include "sim/central_differences.h"

#include <algorithm>
#include <cmath>

#include "kernel/assert.h"
#include "sim/parallel.h"
#include "sim/velocity_march.h"

namespace selvage::sim {

CentralDifferences::CentralDifferences(const SpringSystem& springs, const CentralDifferencesOptions& options)
    : springs_(springs), options_(options), along_(springs.springs().size()), strain_(springs, options.strain) {
  SELVAGE_ASSERT(options.step_s > 0);
  for (const Spring& spring : springs.springs()) damping_.push_back(spring.damping_n_s_m);
}

void CentralDifferences::find_forces(const Positions& x) {
  springs_.stretch(x, stretch_);
  springs_.elastic_forces(stretch_, force_);
  if (options_.stabilizers != nullptr) options_.stabilizers->add_forces(x, 1, 0, force_);
}

void CentralDifferences::find_damping(const Positions& v, std::span<const double> inverse_mass) {
  damping_impulses({springs_, inverse_mass, 0, damping_, options_.stabilizers, 0, 1}, stretch_.direction, v,
                   damping_force_);
}

void CentralDifferences::explicit_half_kick(Motion& motion, std::span<const double> inverse_mass, double h) {
  parallel_each(motion.v.rows(), [&](Eigen::Index i) {
    const double w = inverse_mass[static_cast<std::size_t>(i)];
    if (w == 0) return;
    const double drag_1_s = options_.drag_1_s + options_.quadratic_drag_1_m * motion.v.row(i).norm();
    motion.v.row(i) +=
        h / 2 *
        (options_.gravity_m_s2.transpose() - drag_1_s * motion.v.row(i) + w * (force_.row(i) - damping_force_.row(i)));
  });
}

void CentralDifferences::implicit_half_kick(Motion& motion, std::span<const double> inverse_mass, double h,
                                            double stiffness_share) {
  const double stiffness_s2 = stiffness_share * (h / 2) * (h / 2);
  for (std::size_t s = 0; s < damping_.size(); ++s) {
    along_[s] = h / 2 * damping_[s] + stiffness_s2 * springs_.springs()[s].stiffness_n_m;
  }
  const VelocitySystem system{springs_,     inverse_mass, options_.drag_1_s, along_, options_.stabilizers,
                              stiffness_s2, h / 2};
  rhs_ = motion.v;
  parallel_each(rhs_.rows(), [&](Eigen::Index i) {
    const double w = inverse_mass[static_cast<std::size_t>(i)];
    if (w > 0) rhs_.row(i) += h / 2 * (options_.gravity_m_s2.transpose() + w * force_.row(i));
  });
  if (options_.quadratic_drag_1_m > 0) {
    motion.v = rhs_;
    march(system, inverse_mass, h / 2, motion.v);
    find_damping(motion.v, inverse_mass);
  } else {
    solver_.solve(system, stretch_.direction, rhs_, h / 2, motion.v);
    damping_force_ = solver_.impulses() / (h / 2);
  }
}

// rhs holds the elastic kick, which does not depend on the velocity; the march adds what does.
void CentralDifferences::march(const VelocitySystem& system, std::span<const double> inverse_mass, double time_s,
                               Positions& v) {
  double rate_1_s = 0, speed = 0;
  for (Eigen::Index i = 0; i < v.rows(); ++i) {
    const auto vertex = static_cast<std::size_t>(i);
    if (inverse_mass[vertex] == 0) continue;
    double row = 0;  // Gershgorin: twice the diagonal of the springs' part
    for (const SpringSystem::End& end : springs_.ends_at(static_cast<VertexId>(i))) row += 2 * along_[end.spring];
    if (system.stabilizers != nullptr) {
      row += system.stabilizers->row_sum(static_cast<VertexId>(i), system.stabilizer_stiffness_share,
                                         system.stabilizer_damping_share);
    }
    rate_1_s = std::max(rate_1_s, inverse_mass[vertex] * row / time_s);
    speed = std::max(speed, v.row(i).norm());
  }
  rate_1_s += options_.drag_1_s + 2 * options_.quadratic_drag_1_m * speed;
  const auto acceleration = [&](const Positions& u, Positions& a) {
    damping_impulses(system, stretch_.direction, u, a);
    parallel_each(a.rows(), [&](Eigen::Index i) {
      const double w = inverse_mass[static_cast<std::size_t>(i)];
      if (w > 0) {
        const double drag_1_s = options_.drag_1_s + options_.quadratic_drag_1_m * u.row(i).norm();
        a.row(i) = -(w / time_s) * a.row(i) - drag_1_s * u.row(i);
      } else {
        a.row(i).setZero();
      }
    });
  };
  march_velocity(acceleration, rate_1_s, time_s, 1, v);
}

DynamicsReport CentralDifferences::advance(Motion& motion, const PositionsRef& scripted_x_t1,
                                           std::span<const double> inverse_mass, double dt_s) {
  const int step_count = static_cast<int>(std::ceil(dt_s / options_.step_s));
  const double h = dt_s / step_count;
  for (Eigen::Index i = 0; i < motion.x.rows(); ++i) {
    if (inverse_mass[static_cast<std::size_t>(i)] == 0) {
      motion.v.row(i) = (scripted_x_t1.row(i) - motion.x.row(i)) / dt_s;
    }
  }
  internal_step_s_ = h;
  const Positions x_t0 = motion.x;
  find_forces(motion.x);
  find_damping(motion.v, inverse_mass);
  for (int step = 0; step < step_count; ++step) {
    explicit_half_kick(motion, inverse_mass, h);
    strain_.limit_strain(inverse_mass, motion.x, stretch_, h, motion.v);
    strain_.limit_strain_rate(inverse_mass, motion.x, stretch_, h, motion.v);
    motion.x += h * motion.v;
    if (step + 1 == step_count) last_midstep_v_ = motion.v;
    find_forces(motion.x);
    implicit_half_kick(motion, inverse_mass, h, 0);
  }
  for (Eigen::Index i = 0; i < motion.x.rows(); ++i) {
    if (inverse_mass[static_cast<std::size_t>(i)] == 0) motion.x.row(i) = scripted_x_t1.row(i);
  }
  average_v_ = (motion.x - x_t0) / dt_s;
  return {};
}

void CentralDifferences::final_velocity(Motion& motion, std::span<const double> inverse_mass, double dt_s) {
  double h = dt_s;
  if (internal_step_s_ > 0) {
    h = internal_step_s_;
    parallel_each(motion.v.rows(), [&](Eigen::Index i) {
      if (inverse_mass[static_cast<std::size_t>(i)] > 0) motion.v.row(i) += last_midstep_v_.row(i) - average_v_.row(i);
    });
  }
  find_forces(motion.x);
  implicit_half_kick(motion, inverse_mass, h, 1);
  strain_.limit_strain_rate(inverse_mass, motion.x, stretch_, h, motion.v);
}

}  // namespace selvage::sim
