#include "sim/dynamics/central_differences.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "kernel/assert.h"
#include "sim/base/parallel.h"
#include "sim/dynamics/drag_steps.h"
#include "sim/dynamics/scripted_ends.h"
#include "sim/dynamics/swept_contacts.h"
#include "sim/dynamics/velocity_march.h"
#include "sim/springs/spring_strain.h"

namespace selvage::sim {
namespace {

// Steps of h seconds, the `share` of the stable one, conserve v^T M v / 2 + E + h/2 x^T K v, where E is the elastic
// energy at x, of linear springs, and v the velocity from there to the next x: at least (1 - share^2) E, and no more
// than that where cloth swings back. Contact that stops it there leaves all of E. So each contact may multiply elastic
// energy by up to 1 / (1 - share^2): 5.3 times at 0.9, twice at 0.7, 1.1 times at 0.35. Where cloth is hardly stretched
// this was not seen to matter: the limit counts every spring in all directions, which only stretched ones resist. The
// more they are stretched, the shorter steps are. That changes from step to step, which conserves nothing either: in
// springs without damping, contact or limits on strain energy can rise by it. docs/measurements/stability.md (*Energy
// in contact of stretched cloth*) says what was measured.
constexpr double kStretchedShare = 0.9;  // over the longest spring in units of its length at rest
constexpr double kLeastShare = 0.35;

// Beyond what bodies that pull make of cloth all over (0.27, sim/springs/spring_strain.cpp).
constexpr double kStretched = 0.3;

}  // namespace

CentralDifferences::CentralDifferences(const SpringSystem& springs, const CentralDifferencesOptions& options)
    : options_(options), system_(springs), springs_(springs, options.stabilizers), strain_(springs, options.strain) {
  SELVAGE_ASSERT(options.step_s > 0 && options.stable_step_s > 0);
}

int CentralDifferences::step_count_in_contact(double dt_s, const PositionsRef& x) const {
  const double elongation = largest_elongation(system_, x);
  if (!(elongation > kStretched)) return step_count(dt_s, options_.step_s);
  const double share = std::max(kStretchedShare / (1 + elongation), kLeastShare);
  return step_count(dt_s, std::min(options_.step_s, share * options_.stable_step_s));
}

void CentralDifferences::implicit_half_kick(double h, double residual) {
  elastic_half_kick({h, options_.fields}, inverse_mass_, force_, v_, rhs_);
  const VelocitySystem system{springs_, x_, inverse_mass_, options_.fields.drag_1_s};
  if (options_.fields.quadratic_drag_1_m > 0) {
    march(system, h / 2);
  } else {
    solver_.solve(system, rhs_, h / 2, impulses_, v_, residual);
  }
}

// What is left of a residual is an error of the impulses, with which the next half step begins: x times as large in a
// mode of which B takes x times the momentum. Where that comes to the mode itself, damping feeds what it should take: a
// sheet of 16 x 16 vertices that swings for 3 s gained energy where residual times x was 0.85 (residual 0.05) and 0.5
// (0.01), and none where it was 0.73 and 0.25.
double CentralDifferences::velocity_residual() const {
  constexpr double kMaxError = 0.2;
  double most = 0;
  for (Eigen::Index i = 0; i < x_.rows(); ++i) {
    most = std::max(most, inverse_mass_[i] * springs_.row_sum(static_cast<VertexId>(i)));
  }
  return most > 0 ? std::min(kVelocityResidual, kMaxError / most) : kVelocityResidual;
}

// rhs_ holds the elastic kick, which does not depend on the velocity. It acts along the march: a body that falls as
// fast as drag lets it goes on so, however many steps that takes.
void CentralDifferences::march(const VelocitySystem& system, double time_s) {
  Positions v(rhs_.rows(), 3), kicked(rhs_.rows(), 3);
  v_.copy_to(v);
  rhs_.copy_to(kicked);
  const Positions elastic = (kicked - v) / time_s;
  double rate_1_s = 0, speed = 0;
  RowDrag drag{Eigen::ArrayXd::Zero(rhs_.rows()), Eigen::ArrayXd::Zero(rhs_.rows())};
  for (Eigen::Index i = 0; i < rhs_.rows(); ++i) {
    const double w = system.inverse_mass[i];
    if (w == 0) continue;
    rate_1_s = std::max(rate_1_s, w * springs_.row_sum(static_cast<VertexId>(i)) / time_s);
    const double terminal_m_s = std::sqrt(elastic.row(i).norm() / options_.fields.quadratic_drag_1_m);
    speed = std::max({speed, v.row(i).norm(), std::min(kicked.row(i).norm(), terminal_m_s)});
    drag.linear_1_s[i] = options_.fields.drag_1_s;
    drag.quadratic_1_m[i] = options_.fields.quadratic_drag_1_m;
  }
  rate_1_s += 2 * options_.fields.quadratic_drag_1_m * speed;
  const auto acceleration = [&](const Positions& u, Positions& a) {
    v_.copy(u);
    springs_.multiply(x_, v_, impulses_);
    a.resize(u.rows(), 3);
    parallel_each(a.rows(), [&](Eigen::Index i) {
      a.row(i) = elastic.row(i) - (system.inverse_mass[i] / time_s) * impulses_.row(i);
    });
  };
  march_velocity(acceleration, drag, rate_1_s, time_s, v);
  v_.copy(v);
  springs_.multiply(x_, v_, impulses_);
}

DynamicsReport CentralDifferences::advance(Motion& motion, const PositionsRef& scripted_x_t1,
                                           std::span<const double> inverse_mass, double dt_s, HeldContacts* contacts) {
  const int count =
      std::max(contacts == nullptr ? step_count(dt_s, options_.step_s) : step_count_in_contact(dt_s, motion.x),
               steps_for_drag(quadratic_drag_1_s(options_.fields.quadratic_drag_1_m, motion.v, inverse_mass), dt_s));
  const double h = dt_s / count;
  start_scripts(motion, scripted_x_t1, inverse_mass, dt_s);
  internal_step_s_ = h;
  strain_.forget();
  inverse_mass_.copy(inverse_mass);
  x_.copy(motion.x);
  v_.copy(motion.v);
  springs_.set_shares({h / 2, 0}, inverse_mass);
  const double residual = velocity_residual();
  springs_.look(x_, force_);
  springs_.multiply(x_, v_, impulses_);
  std::optional<SweptContacts> swept;
  if (contacts != nullptr) swept.emplace(*contacts);
  for (int step = 0; step < count; ++step) {
    explicit_half_kick({h, options_.fields}, inverse_mass_, force_, impulses_, x_, v_, x_t1_);
    const LimitedMotion limited{x_, h, v_, x_t1_};
    const MidstepMotion held{h, double(step + 1) / count, x_t1_, v_};
    const auto limit = [&] {
      strain_.limit_strain(inverse_mass, limited);
      strain_.limit_strain_rate(inverse_mass, limited);
    };
    if (swept) {
      swept->hold(held, limit);
    } else {
      limit();
    }
    std::swap(x_, x_t1_);
    if (step + 1 == count) last_midstep_v_ = v_;
    springs_.look(x_, force_);
    implicit_half_kick(h, residual);
  }
  if (swept) swept->finish();
  const Positions x_t0 = motion.x;
  x_.copy_to(motion.x);
  v_.copy_to(motion.v);
  end_scripts(motion.x, scripted_x_t1, inverse_mass);
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
  inverse_mass_.copy(inverse_mass);
  x_.copy(motion.x);
  v_.copy(motion.v);
  springs_.set_shares({h / 2, h / 2 * (h / 2)}, inverse_mass);
  const double residual = velocity_residual();
  springs_.look(x_, force_);
  impulses_.set_zero();  // a guess that does not depend on what was before, so that a run resumes with the same bits
  implicit_half_kick(h, residual);
  x_t1_.resize(x_.rows());
  parallel_each(x_.rows(), [&](Eigen::Index i) { x_t1_.row(i) = x_.row(i) + h * v_.row(i); });
  strain_.limit_strain_rate(inverse_mass, {x_, h, v_, x_t1_});
  v_.copy_to(motion.v);
}

}  // namespace selvage::sim
