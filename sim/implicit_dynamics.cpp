#include "sim/implicit_dynamics.h"

#include <cmath>
#include <numbers>

#include "kernel/assert.h"

namespace selvage::sim {
namespace {

constexpr double kStageShare = 1 - 1 / std::numbers::sqrt2;

CentralDifferencesOptions half_kick_options(const ImplicitDynamicsOptions& options) {
  CentralDifferencesOptions half_kick;
  half_kick.gravity_m_s2 = options.fields.gravity_m_s2;
  half_kick.drag_1_s = options.fields.drag_1_s;
  half_kick.quadratic_drag_1_m = options.fields.quadratic_drag_1_m;
  half_kick.strain = options.strain;
  half_kick.strain.strain_rate = 0;
  half_kick.step_s = options.step_s;
  half_kick.stabilizers = options.stabilizers;
  return half_kick;
}

void add_stage(const StageReport& stage, DynamicsReport& report) {
  ++report.solves;
  report.newton_rounds += stage.newton_rounds;
  report.cg_iterations += stage.cg_iterations;
  report.unconverged += stage.converged ? 0 : 1;
  // Written so that NaN is kept.
  if (!(stage.residual_m <= report.residual_m)) report.residual_m = stage.residual_m;
}

}  // namespace

ImplicitDynamics::ImplicitDynamics(const SpringSystem& springs, const ImplicitDynamicsOptions& options)
    : options_(options),
      strain_(springs, options.strain),
      stage_(springs, options.stabilizers, options.fields),
      half_kick_(springs, half_kick_options(options)) {
  SELVAGE_ASSERT(options.step_s > 0);
}

DynamicsReport ImplicitDynamics::advance(Motion& motion, const PositionsRef& scripted_x_t1,
                                         std::span<const double> inverse_mass, double dt_s,
                                         HeldContacts* /*contacts*/) {
  const int step_count = static_cast<int>(std::ceil(dt_s / options_.step_s));
  for (Eigen::Index i = 0; i < motion.x.rows(); ++i) {
    if (inverse_mass[static_cast<std::size_t>(i)] == 0) {
      motion.v.row(i) = (scripted_x_t1.row(i) - motion.x.row(i)) / dt_s;
    }
  }
  DynamicsReport report;
  for (int n = 0; n < step_count; ++n) step(motion, inverse_mass, dt_s / step_count, report);
  for (Eigen::Index i = 0; i < motion.x.rows(); ++i) {
    if (inverse_mass[static_cast<std::size_t>(i)] == 0) motion.x.row(i) = scripted_x_t1.row(i);
  }
  return report;
}

// Held vertices have no acceleration, so both stages move them with their velocity.
void ImplicitDynamics::step(Motion& motion, std::span<const double> inverse_mass, double h, DynamicsReport& report) {
  const double stage_s = kStageShare * h, rest_s = h - stage_s;
  const Positions x_t0 = motion.x;
  Positions origin = x_t0, v = motion.v;
  const auto solve_stage = [&] {
    for (Eigen::Index i = 0; i < motion.x.rows(); ++i) {
      if (inverse_mass[static_cast<std::size_t>(i)] == 0) motion.x.row(i) = origin.row(i) + stage_s * v.row(i);
    }
    const StageReport stage = stage_.solve({origin, v, inverse_mass, stage_s}, motion.x, acceleration_);
    add_stage(stage, report);
    // Where the forces put them, which are opposite in pairs: the residual has a momentum of its own, and contact and
    // strain limits take velocities from positions.
    if (stage.residual_m <= ImplicitStage::kResidual_m) motion.x = origin + stage_s * (v + stage_s * acceleration_);
  };
  solve_stage();
  origin += rest_s * (v + stage_s * acceleration_);
  v += rest_s * acceleration_;
  solve_stage();
  motion.v = v + stage_s * acceleration_;
  limit(x_t0, inverse_mass, h, motion);
}

// Like a contact: what the impulses leave is the mean velocity.
void ImplicitDynamics::limit(const Positions& x_t0, std::span<const double> inverse_mass, double h, Motion& motion) {
  x_t0_.copy(x_t0);
  x_t1_.copy(motion.x);
  mean_v_.copy((motion.x - x_t0) / h);
  if (strain_.limit_strain(inverse_mass, {x_t0_, h, mean_v_, x_t1_}) == 0) return;
  x_t1_.copy_to(motion.x);
  mean_v_.copy_to(motion.v);
  final_velocity(motion, inverse_mass, h);
}

void ImplicitDynamics::final_velocity(Motion& motion, std::span<const double> inverse_mass, double dt_s) {
  half_kick_.final_velocity(motion, inverse_mass, dt_s);
}

}  // namespace selvage::sim
