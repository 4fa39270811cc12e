#include "sim/dynamics/implicit_dynamics.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kernel/assert.h"
#include "sim/base/keep_largest.h"
#include "sim/base/parallel.h"
#include "sim/contact/cloth_sets.h"
#include "sim/dynamics/drag_steps.h"
#include "sim/dynamics/scripted_ends.h"
#include "sim/dynamics/stage_contacts.h"

namespace selvage::sim {
namespace {

constexpr double kStageShare = 1 - 1 / std::numbers::sqrt2;
// Two stages turn a velocity round that drag takes away at more than this over h, 1 / (1 - 2 kStageShare). A linear
// rate r leaves 1 / (1 + kStageShare r h) of it in the first stage, and before the second that has changed by (1 -
// kStageShare) / kStageShare of how much the first changed it; drag that grows with speed leaves more.
constexpr double kMaxBraked = 1 + std::numbers::sqrt2;

// What contacts bear is found to this part of the largest of it, in each of them or in what they bear together: where
// many share a load they may pass it on between them for ever. Or as far as so many solutions of the stage find it;
// what is left, the collision step repels. A thousandth took 1.3 times the rounds of cloth at rest on cloth and 1.25
// times those of the demo with stiff springs, as what is left has to be found in the next step; a hundred-thousandth
// takes 0.9 at rest and 1.17 times as many where cloth slides.
constexpr double kForceResidual = 1e-4;
constexpr int kForceRounds = 12;
// Contacts may slide where the stage is solved to this, and what they bear found to this part: a cone may seem a little
// too narrow, and what slides goes on sliding where kinetic friction is weaker. Of 36 sheets of 12 x 12 vertices that
// static friction 0.5 to 6 % above the slope should have held, with a kinetic one of a ninth of it, 14 slid so; 24 in
// stages solved to 1e-3 m, and 13 in stages solved to 1e-9 m, for 6 % more iterations. All stuck from 15 % on. To wait
// until all is found took 1.3 times the iterations in the demo.
constexpr double kSlideResidual_m = 1e-5, kSlideResidual = 1e-2;
// Contacts begin to slide in an earlier solution than this, after which as many as above may follow, and a last one.
constexpr int kLastSlide = 3 * kForceRounds;
// The stage is solved to the first, then to a part of how far what the contacts bear has last changed, and to the last
// in the end. docs/measurements/numerics.md has what other ways take. Closer than without contact: cloth at rest goes
// by what is left wherever that points, since what it bears is remembered. To 1e-9 m the energy of a sheet at rest on a
// plane rose by 3e-9 of that of its fall in 50 steps (Energy.NeverRisesInContactWithAPlane), for 0.95 of the
// iterations.
constexpr double kFirstResidual_m = 1e-3, kShareOfChange = 0.1, kLastResidual_m = 1e-10;

/// What hangs together with contacts, and what does not: it takes two stages, whatever others meet (drag that brakes
/// any makes of all one stage, and of steps more). Cloth that swung beside a sheet at rest 20 m away had 0.54 of its
/// energy left after 4 s where 0.99 is right, and a sheet that spun at 20 rad/s 0.57 of its angular momentum after 0.7
/// s.
struct ClothInContact {
  std::vector<std::uint8_t> is_in_contact = {};                              ///< #V
  std::vector<double> inverse_mass_free = {}, inverse_mass_in_contact = {};  ///< #V: zero for the others
  bool is_free_anywhere = false;
};

ClothInContact cloth_in_contact(const HeldContacts& contacts, std::span<const double> inverse_mass) {
  const HeldSurface& surface = contacts.surface();
  const auto count = static_cast<VertexId>(surface.cloth_count);
  ClothSets sets(surface.parts, count);
  for (const RepulsionContact& contact : contacts.contacts()) sets.join(contact.interaction.vertices);
  std::vector<std::uint8_t> meets(static_cast<std::size_t>(count));  // by set
  for (const RepulsionContact& contact : contacts.contacts()) {
    for (const VertexId v : contact.interaction.vertices) {
      if (sets.is_cloth(v)) meets[sets.set(v)] = 1;
    }
  }
  ClothInContact result{std::vector<std::uint8_t>(meets.size()), {inverse_mass.begin(), inverse_mass.begin() + count}};
  result.inverse_mass_in_contact = result.inverse_mass_free;
  for (VertexId v = 0; v < count; ++v) {
    const auto row = static_cast<std::size_t>(v);
    result.is_in_contact[row] = meets[sets.set(v)];
    result.is_free_anywhere = result.is_free_anywhere || (result.is_in_contact[row] == 0 && inverse_mass[row] > 0);
    (result.is_in_contact[row] != 0 ? result.inverse_mass_free : result.inverse_mass_in_contact)[row] = 0;
  }
  return result;
}

void add_stage(const StageReport& stage, DynamicsReport& report) {
  ++report.solves;
  report.newton_rounds += stage.newton_rounds;
  report.cg_iterations += stage.cg_iterations;
  report.unconverged += stage.converged ? 0 : 1;
  keep_largest(stage.residual_m, report.residual_m);
}

}  // namespace

ImplicitDynamics::ImplicitDynamics(const SpringSystem& springs, const ImplicitDynamicsOptions& options)
    : step_s_(options.step_s), strain_(springs, options.strain), stage_(springs, options.stabilizers, options.fields) {
  SELVAGE_ASSERT(step_s_ > 0);
}

DynamicsReport ImplicitDynamics::advance(Motion& motion, const PositionsRef& scripted_x_t1,
                                         std::span<const double> inverse_mass, double dt_s, HeldContacts* contacts) {
  const int step_count =
      std::max(static_cast<int>(std::ceil(dt_s / step_s_)),
               steps_for_drag(quadratic_drag_1_s(stage_.fields().quadratic_drag_1_m, motion.v, inverse_mass), dt_s));
  start_scripts(motion, scripted_x_t1, inverse_mass, dt_s);
  const Positions x_t0 = motion.x;
  const double h = dt_s / step_count;
  DynamicsReport report;
  const ClothInContact cloth = contacts != nullptr ? cloth_in_contact(*contacts, inverse_mass) : ClothInContact{};
  for (int n = 0; n < step_count; ++n) {
    if (contacts == nullptr) {
      step(motion, inverse_mass, h, report);
      continue;
    }
    const StageSpan span{double(n) / step_count, double(n + 1) / step_count, h};
    if (!cloth.is_free_anywhere) {
      step_in_contact(motion, inverse_mass, span, *contacts, report);
      continue;
    }
    Motion free = motion;
    step(free, cloth.inverse_mass_free, h, report);
    step_in_contact(motion, cloth.inverse_mass_in_contact, span, *contacts, report);
    for (Eigen::Index i = 0; i < motion.x.rows(); ++i) {
      if (cloth.is_in_contact[static_cast<std::size_t>(i)] != 0) continue;
      motion.x.row(i) = free.x.row(i);
      motion.v.row(i) = free.v.row(i);
    }
  }
  end_scripts(motion.x, scripted_x_t1, inverse_mass);
  end_v_ = motion.v;
  average_v_ = (motion.x - x_t0) / dt_s;
  return report;
}

/// Whether drag stops something within the step.
bool ImplicitDynamics::brakes(const Positions& v, std::span<const double> inverse_mass, double h) const {
  const FieldForces& fields = stage_.fields();
  return h * (fields.drag_1_s + quadratic_drag_1_s(fields.quadratic_drag_1_m, v, inverse_mass)) > kMaxBraked;
}

// Held vertices have no acceleration, so both stages move them with their velocity.
void ImplicitDynamics::step(Motion& motion, std::span<const double> inverse_mass, double h, DynamicsReport& report) {
  const double stage_s = brakes(motion.v, inverse_mass, h) ? h : kStageShare * h, rest_s = h - stage_s;
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
  if (rest_s > 0) {
    origin += rest_s * (v + stage_s * acceleration_);
    v += rest_s * acceleration_;
    solve_stage();
  }
  motion.v = v + stage_s * acceleration_;
  limit(x_t0, inverse_mass, h, motion);
}

void ImplicitDynamics::step_in_contact(Motion& motion, std::span<const double> inverse_mass, const StageSpan& span,
                                       HeldContacts& contacts, DynamicsReport& report) {
  const double h = span.h_s;
  const Positions x_t0 = motion.x, v_t0 = motion.v;
  for (Eigen::Index i = 0; i < motion.x.rows(); ++i) {
    if (inverse_mass[static_cast<std::size_t>(i)] == 0) motion.x.row(i) += h * motion.v.row(i);
  }
  StageContacts terms(contacts, x_t0, inverse_mass, stage_.resistance_kg(inverse_mass, h), span);
  const StageEquations equations{x_t0, v_t0, inverse_mass, h, &terms};
  const Positions first_guess = motion.x;
  StageReport all = solve_in_contact(equations, motion.x);
  if (!all.converged && terms.forget()) {
    Positions x = first_guess;
    StageReport again = solve_in_contact(equations, x);
    const bool is_better = again.converged || !(all.residual_m <= again.residual_m);  // not NaN, if one is none
    if (is_better) motion.x = x;
    StageReport& kept = is_better ? again : all;
    kept.newton_rounds = all.newton_rounds + again.newton_rounds;
    kept.cg_iterations = all.cg_iterations + again.cg_iterations;
    all = kept;
  }
  add_stage(all, report);
  if (all.converged) terms.finish();  // else what they bore is worth nothing
  // Where the forces put it, as above; but what was not solved goes no farther than it did.
  motion.v = all.converged ? Positions(v_t0 + h * acceleration_) : Positions((motion.x - x_t0) / h);
  if (all.residual_m <= ImplicitStage::kResidual_m) motion.x = x_t0 + h * motion.v;
  limit(x_t0, inverse_mass, h, motion);
}

StageReport ImplicitDynamics::solve_in_contact(const StageEquations& equations, Positions& x) {
  StageContacts& terms = *equations.contacts;
  stage_.fly_free(equations, x);
  StageReport all;
  double enough_m = kFirstResidual_m;
  for (int round = 1, last = kForceRounds;; ++round) {
    const StageReport stage = stage_.solve(equations, x, acceleration_, enough_m);
    all = {all.newton_rounds + stage.newton_rounds, all.cg_iterations + stage.cg_iterations, stage.first_residual_m,
           stage.residual_m, stage.converged};
    if (!stage.converged) return all;
    const ForceChange change = terms.update();
    const double left = change.share(kLastResidual_m);
    const bool may_slide = (left <= kSlideResidual && enough_m <= kSlideResidual_m) || round >= last;
    const bool slides = may_slide && round < kLastSlide && terms.let_slide(kLastResidual_m);
    if (slides) last = round + kForceRounds;
    // What the last update left out of balance, before anything moved.
    const bool is_balanced = round > 1 && stage.first_residual_m <= kForceResidual * change.largest_m;
    const bool is_found = !slides && (left <= kForceResidual || is_balanced || round >= last);
    if (is_found && enough_m == kLastResidual_m) return all;
    enough_m = is_found ? kLastResidual_m : std::clamp(kShareOfChange * change.change_m, kLastResidual_m, enough_m);
  }
}

// Impulses change the velocity at the end by as much as the mean velocity, from which, without contact, it differs by
// half of what forces did in the step: to put that in its place for all cloth, once one spring was limited anywhere,
// halved gravity.
void ImplicitDynamics::limit(const Positions& x_t0, std::span<const double> inverse_mass, double h, Motion& motion) {
  x_t0_.copy(x_t0);
  x_t1_.copy(motion.x);
  mean_v_.copy((motion.x - x_t0) / h);
  strain_.forget();
  if (strain_.limit_strain(inverse_mass, {x_t0_, h, mean_v_, x_t1_}) == 0) return;
  for (Eigen::Index i = 0; i < motion.v.rows(); ++i) {
    motion.v.row(i) += mean_v_.row(i) - (motion.x.row(i) - x_t0.row(i)) / h;  // the same bits where nothing was changed
  }
  x_t1_.copy_to(motion.x);
}

void ImplicitDynamics::final_velocity(Motion& motion, std::span<const double> inverse_mass, double /*dt_s*/) {
  SELVAGE_ASSERT(end_v_.rows() == motion.v.rows());
  parallel_each(motion.v.rows(), [&](Eigen::Index i) {
    if (inverse_mass[static_cast<std::size_t>(i)] > 0) motion.v.row(i) += end_v_.row(i) - average_v_.row(i);
  });
}

}  // namespace selvage::sim
