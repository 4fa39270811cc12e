#include "fuzz/oracle/step_oracle.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "verify/distance_check.h"

namespace selvage::fuzz {
namespace {

/// Beyond this, squares and sums of momenta leave the range of double: the balances are not looked at.
constexpr double kBalanceLimit = 0x1p+400;
/// Nor beyond this with float32: what goes to the edge of its range, 2^128, is cut there, and so is its momentum.
constexpr double kFloatBalanceLimit = 0x1p+100;

bool has_scripted(const StepWorld& world) {
  return std::any_of(world.inverse_mass.begin(), world.inverse_mass.end(), [](double w) { return w == 0; });
}

bool is_on_lattice(const Positions& x) { return (x.cast<float>().cast<double>().array() == x.array()).all(); }

/// What a vertex goes to where nothing disturbs it.
Positions undisturbed(const StepWorld& world, const Positions& candidate) {
  if (world.options.precision == sim::CollisionOptions::Precision::kFloat64) return candidate;
  constexpr double kMaxFloat = static_cast<double>(std::numeric_limits<float>::max());
  return candidate.cwiseMax(-kMaxFloat).cwiseMin(kMaxFloat).cast<float>().cast<double>();
}

StepDefect check_scripts(const StepWorld& world, const Positions& x_t0, const Positions& candidate,
                         const sim::CollisionStepResult& result) {
  const Positions target = undisturbed(world, candidate);
  const auto &bodies = result.report.waiting_bodies, &vertices = result.report.waiting_vertices;
  for (Eigen::Index i = 0; i < x_t0.rows(); ++i) {
    const auto vertex = static_cast<std::size_t>(i);
    if (world.inverse_mass[vertex] != 0) continue;
    const auto number = static_cast<std::int32_t>(i);
    const bool waits = std::ranges::binary_search(vertices, number);
    const bool body_waits = std::ranges::binary_search(bodies, world.body[vertex]);
    if (waits != body_waits && !(body_waits && world.deforms(number))) return StepDefect::kOffScript;
    if (waits && world.policy == sim::SqueezePolicy::kStop) return StepDefect::kOffScript;
    if (result.x.row(i) != (waits ? x_t0.row(i) : target.row(i))) return StepDefect::kOffScript;
  }
  return StepDefect::kNone;
}

/// Positions and velocities must tell of the same motion: x is V_t0 + dt velocity, rounded to its lattice.
bool velocity_is_that_of_the_motion(const StepWorld& world, const Positions& x_t0,
                                    const sim::CollisionStepResult& result) {
  const bool float32 = world.options.precision == sim::CollisionOptions::Precision::kFloat32;
  // One rounding to the lattice, half of its unit; in doubles a few, of sum, difference and quotient.
  const double unit = float32 ? 0x1p-24 : 0x1p-50;
  const double least = float32 ? 0x1p-149 : 0x1p-1070;
  for (Eigen::Index i = 0; i < x_t0.rows(); ++i) {
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      const double moved = world.dt_s * result.velocity(i, axis);
      const double off = std::abs((result.x(i, axis) - x_t0(i, axis)) - moved);
      const double size = std::abs(result.x(i, axis)) + std::abs(x_t0(i, axis)) + std::abs(moved);
      if (size < kBalanceLimit && off > unit * size + least) return false;
    }
  }
  return true;
}

/// Every pair of the cloth that the exact check finds nearer than the tolerance at the end must be in the report.
bool all_near_pairs_are_named(const StepWorld& world, const sim::CollisionStepResult& result) {
  std::set<std::pair<PairKind, std::array<std::int32_t, 2>>> named;
  for (const Collision& pair : result.report.below_tolerance) named.insert({pair.kind, {pair.first, pair.second}});
  const auto near = verify::near_pairs(world.topology, sim::points_of(result.x), world.options.tolerance_m);
  return std::ranges::all_of(near, [&](const verify::Violation& pair) {
    const PairKind kind = pair.event == verify::EventKind::kVf ? PairKind::kVf : PairKind::kEe;
    const auto is_scripted = [&](std::int32_t v) { return v < 0 || world.is_scripted(v); };
    return named.contains({kind, pair.features}) || std::ranges::all_of(pair.vertices, is_scripted);
  });
}

double mass_of(const StepWorld& world, Eigen::Index vertex) {
  return 1 / world.inverse_mass[static_cast<std::size_t>(vertex)];
}

StepDefect check_balances(const StepWorld& world, const Positions& x_t0, const Positions& candidate,
                          const sim::CollisionStepResult& result) {
  const double largest = std::max(candidate.cwiseAbs().maxCoeff(), x_t0.cwiseAbs().maxCoeff());
  const bool float32 = world.options.precision == sim::CollisionOptions::Precision::kFloat32;
  const double limit = float32 ? kFloatBalanceLimit : kBalanceLimit;
  if (largest > limit || result.report.fail_safe_vertices > 0 || result.report.cut_candidates > 0)
    return StepDefect::kNone;
  const Positions before = (candidate - x_t0) / world.dt_s;
  Eigen::RowVector3d change = Eigen::RowVector3d::Zero();
  double size = 0;
  double energy_before = 0;
  double energy_after = 0;
  for (Eigen::Index i = 0; i < before.rows(); ++i) {
    const double mass = mass_of(world, i);
    change += mass * (result.velocity.row(i) - before.row(i));
    size += mass * (result.velocity.row(i).norm() + before.row(i).norm());
    energy_before += mass * before.row(i).squaredNorm();
    energy_after += mass * result.velocity.row(i).squaredNorm();
  }
  // Hundreds of sums and products of roundoff 1e-16 each; positions far from the origin enter through differences.
  const double rounding = 1e-9 * size + 1e-12 * largest / world.dt_s;
  if (change.norm() > rounding) return StepDefect::kMomentum;
  // Springs, and the push of pairs that are nearer than the tolerance, add energy on purpose.
  const bool pushes =
      (world.options.repulsion && world.options.repulsion_stiffness_n_m > 0) || world.options.tolerance_m > 0;
  if (!pushes && energy_after > energy_before * (1 + 1e-9)) return StepDefect::kEnergy;
  return StepDefect::kNone;
}

bool is_undisturbed(const sim::CollisionStepReport& report) {
  return report.proximities == 0 && report.first_collisions == 0 && report.below_tolerance.empty() &&
         report.waiting_bodies.empty() && report.cut_candidates == 0;
}

}  // namespace

std::string_view name_of(StepDefect defect) {
  switch (defect) {
    case StepDefect::kNone:
      return "none";
    case StepDefect::kTouches:
      return "touches";
    case StepDefect::kRejected:
      return "rejected";
    case StepDefect::kStoppedFreely:
      return "stopped-freely";
    case StepDefect::kUnnamedNear:
      return "unnamed-near";
    case StepDefect::kOffScript:
      return "off-script";
    case StepDefect::kOffLattice:
      return "off-lattice";
    case StepDefect::kBadVelocity:
      return "bad-velocity";
    case StepDefect::kMomentum:
      return "momentum";
    case StepDefect::kEnergy:
      return "energy";
    case StepDefect::kInterferes:
      return "interferes";
    case StepDefect::kNotRefused:
      return "not-refused";
    case StepDefect::kOutsideDomain:
      break;
  }
  return "outside-domain";
}

sim::CollisionStepResult selvage_step(const StepWorld& world, const Positions& x_t0, const Positions& candidate) {
  sim::CollisionStep step(world.mesh, world.options);
  return step(x_t0, candidate, world.bodies(), world.dt_s);
}

namespace {

/// A script is followed exactly, so one beyond the domain, or the largest float32, must be refused.
bool a_script_leaves_the_domain(const StepWorld& world, const Positions& candidate) {
  const bool float32 = world.options.precision == sim::CollisionOptions::Precision::kFloat32;
  const double limit = float32 ? static_cast<double>(std::numeric_limits<float>::max()) : kMaxCoordinate;
  for (Eigen::Index v = 0; v < candidate.rows(); ++v) {
    const bool is_scripted = world.inverse_mass[static_cast<std::size_t>(v)] == 0;
    if (is_scripted && candidate.row(v).cwiseAbs().maxCoeff() > limit) return true;
  }
  return false;
}

}  // namespace

StepDefect judge_step(const StepWorld& world, const Positions& x_t0, const Positions& candidate,
                      const sim::CollisionStepResult& result) {
  const sim::CollisionStepReport& report = result.report;
  if (!candidate.allFinite() || a_script_leaves_the_domain(world, candidate)) {
    return report.status == sim::StepStatus::kInvalidInput ? StepDefect::kNone : StepDefect::kNotRefused;
  }
  switch (report.status) {
    case sim::StepStatus::kInvalidInput:
    case sim::StepStatus::kAbandoned:  // nobody asked for it
      return StepDefect::kRejected;
    case sim::StepStatus::kStopped:
      return has_scripted(world) && report.witness && result.x == x_t0 ? StepDefect::kNone : StepDefect::kStoppedFreely;
    case sim::StepStatus::kSafe:
      break;
  }
  const bool all_finite = result.x.allFinite() && result.velocity.allFinite();
  if (!all_finite || result.x.cwiseAbs().maxCoeff() > kMaxCoordinate) {
    return StepDefect::kOutsideDomain;
  }
  const auto motion = verify::check_motion(world.topology, sim::points_of(x_t0), sim::points_of(result.x), {});
  if (cloth_violations(world, motion) != 0) return StepDefect::kTouches;
  if (!all_near_pairs_are_named(world, result)) return StepDefect::kUnnamedNear;
  const bool float32 = world.options.precision == sim::CollisionOptions::Precision::kFloat32;
  if (float32 && !is_on_lattice(result.x)) return StepDefect::kOffLattice;
  if (const StepDefect off_script = check_scripts(world, x_t0, candidate, result); off_script != StepDefect::kNone) {
    return off_script;
  }
  if (is_undisturbed(report) && result.x != undisturbed(world, candidate)) return StepDefect::kInterferes;
  const StepDefect unbalanced =
      has_scripted(world) ? StepDefect::kNone : check_balances(world, x_t0, candidate, result);
  if (unbalanced != StepDefect::kNone) return unbalanced;
  return velocity_is_that_of_the_motion(world, x_t0, result) ? StepDefect::kNone : StepDefect::kBadVelocity;
}

namespace {

/// One coordinate is no number.
Positions no_candidate(ChoiceSource& source, const Positions& x) {
  Positions candidate = x;
  const auto place = static_cast<Eigen::Index>(source.n(static_cast<std::uint32_t>(x.size())));
  candidate.reshaped()[place] = source.coin() ? std::numeric_limits<double>::infinity() : std::nan("");
  return candidate;
}

}  // namespace

StepObservation run_steps(ChoiceSource& source, const StepFunction& step) {
  return run_steps(source, make_step_world(source), step);
}

StepObservation run_steps(ChoiceSource& source, const StepWorld& world, const StepFunction& step) {
  StepObservation seen;
  seen.surface = world.surface;
  seen.x_t0 = world.x;
  for (int left = source.range(1, 4); left > 0; --left) {
    seen.x_candidate = choose_candidate(source, world, seen.x_t0, seen.candidate);
    const sim::CollisionStepResult result = step(world, seen.x_t0, seen.x_candidate);
    seen.x_t1 = result.x;
    ++seen.steps;
    seen.with_collisions += result.report.first_collisions > 0;
    seen.with_zones += result.report.zone_rounds > 0;
    seen.with_fail_safe += result.report.fail_safe_vertices > 0;
    seen.stopped += result.report.status == sim::StepStatus::kStopped;
    seen.defect = judge_step(world, seen.x_t0, seen.x_candidate, result);
    if (seen.defect != StepDefect::kNone) return seen;
    if (result.report.status == sim::StepStatus::kInvalidInput) continue;  // refused as it must be: nothing moved
    seen.x_t0 = result.x;
  }
  if (source.one_in(8)) {
    seen.x_candidate = no_candidate(source, seen.x_t0);
    const sim::CollisionStepResult result = step(world, seen.x_t0, seen.x_candidate);
    seen.defect = judge_step(world, seen.x_t0, seen.x_candidate, result);
  }
  return seen;
}

}  // namespace selvage::fuzz
