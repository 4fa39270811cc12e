#include "sim/dynamics/implicit_stage.h"

#include <algorithm>
#include <cmath>

#include "kernel/assert.h"
#include "sim/base/keep_largest.h"
#include "sim/base/parallel.h"
#include "sim/dynamics/stage_contacts.h"

namespace selvage::sim {
namespace {

// Armijo's rule: a step must lower the potential by this part of what its slope promises. Nocedal and Wright 2006, 3.1.
constexpr double kDescent = 1e-4;
constexpr std::int32_t kMaxHalvings = 30;
// A sum of terms of both signs may be off by this part of their magnitudes; the terms themselves hold a few roundings.
constexpr double kSumRounding = 0x1p-46;
// Newton's linear equations are solved to this part of their right-hand side (section 7.1 of Nocedal and Wright). With
// contacts, of which others press in the next round, a tenth took 0.6 to 1.1 times the iterations of a hundredth;
// without them 1.04 to 1.2 times the time.
constexpr double kForcing = 1e-2, kForcingInContact = 1e-1;
constexpr std::int32_t kMaxCgIterations = 1000;
// Forces are sums of a few dozen roundings of the positions.
constexpr double kForceRoundings = 32;

std::vector<std::vector<VertexId>> find_neighbours(const SpringSystem& springs,
                                                   const std::optional<StageStabilizers>& stabilizers) {
  std::vector<std::vector<VertexId>> neighbours(static_cast<std::size_t>(springs.vertex_count()));
  for (const Spring& spring : springs.springs()) {
    neighbours[static_cast<std::size_t>(spring.a)].push_back(spring.b);
    neighbours[static_cast<std::size_t>(spring.b)].push_back(spring.a);
  }
  for (VertexId i = 0; i < springs.vertex_count(); ++i) {
    std::vector<VertexId>& row = neighbours[static_cast<std::size_t>(i)];
    if (stabilizers) stabilizers->list_neighbours(i, row);
    std::sort(row.begin(), row.end());
    row.erase(std::unique(row.begin(), row.end()), row.end());
  }
  return neighbours;
}

/// Row by row in order: the bits do not depend on the number of threads.
double dot(const Positions& a, const Positions& b) {
  double sum = 0;
  for (Eigen::Index i = 0; i < a.rows(); ++i) sum += a(i, 0) * b(i, 0) + a(i, 1) * b(i, 1) + a(i, 2) * b(i, 2);
  return sum;
}

}  // namespace

ImplicitStage::ImplicitStage(const SpringSystem& springs, const StabilizerSystem* stabilizers,
                             const FieldForces& fields)
    : springs_(springs),
      stabilizers_(stabilizers != nullptr ? std::make_optional<StageStabilizers>(*stabilizers) : std::nullopt),
      fields_(fields),
      matrix_(find_neighbours(springs, stabilizers_)),
      is_free_(static_cast<std::size_t>(springs.vertex_count())),
      spring_(springs.springs().size()) {
  for (const Spring& spring : springs.springs()) {
    entry_.push_back(matrix_.find(spring.a, spring.b));
    entry_.push_back(matrix_.find(spring.b, spring.a));
  }
  if (stabilizers_) stabilizers_->find_entries(matrix_);
}

void ImplicitStage::find_forces(const StageEquations& equations, const Positions& x, Positions& acceleration) {
  const double h = equations.h_s;
  u_ = x - equations.origin;
  parallel_each(static_cast<Eigen::Index>(spring_.size()), [&](Eigen::Index s) {
    const Spring& spring = springs_.springs()[static_cast<std::size_t>(s)];
    SpringState& state = spring_[static_cast<std::size_t>(s)];
    const Eigen::RowVector3d d = x.row(spring.b) - x.row(spring.a);
    const double length = d.norm(), k = spring.stiffness_n_m;
    // A spring of length 0 has no direction. It pulls at neither end, and resists in all directions alike.
    const Eigen::RowVector3d n = length > 0 ? Eigen::RowVector3d(d / length) : Eigen::RowVector3d::Zero();
    const double rate = n.dot(u_.row(spring.b) - u_.row(spring.a)) / h;
    state = {n.x(),     n.y(),    n.z(), length, k * (length - spring.rest_length_m) + spring.damping_n_s_m * rate,
             h * h * k, h * h * k};
    if (length > 0) {
      state.along_kg += h * spring.damping_n_s_m;
      state.across_kg = h * h * state.pull_n / length;
    }
  });
  stabilizing_ = Positions::Zero(x.rows(), 3);
  if (stabilizers_) {
    stabilizers_->add_forces(x, 1, 0, stabilizing_);
    stabilizers_->add_forces(u_, 0, 1 / h, stabilizing_);
  }
  if (equations.contacts != nullptr) equations.contacts->look(u_);
  acceleration.resize(x.rows(), 3);
  gradient_.resize(x.rows(), 3);
  linear_.resize(x.rows(), 3);
  parallel_each(x.rows(), [&](Eigen::Index i) {
    const double w = equations.inverse_mass[static_cast<std::size_t>(i)];
    if (w == 0) {
      acceleration.row(i).setZero();
      gradient_.row(i).setZero();
      linear_.row(i).setZero();
      return;
    }
    Eigen::RowVector3d pull = Eigen::RowVector3d::Zero();
    springs_.for_each_at(static_cast<VertexId>(i), [&](std::uint32_t s, double sign) {
      const SpringState& state = spring_[s];
      pull += (sign * state.pull_n) * Eigen::RowVector3d(state.x, state.y, state.z);
    });
    const Eigen::RowVector3d gravity = fields_.gravity_m_s2.transpose();
    const double drag_1_s = fields_.drag_1_s + fields_.quadratic_drag_1_m * u_.row(i).norm() / h;
    acceleration.row(i) = gravity - (drag_1_s / h) * u_.row(i) + w * (pull + stabilizing_.row(i));
    if (equations.contacts != nullptr) acceleration.row(i) += w / (h * h) * equations.contacts->force_at(i);
    const Eigen::RowVector3d coasting = u_.row(i) - h * equations.v_t0.row(i);
    gradient_.row(i) = (coasting - h * h * acceleration.row(i)) / w;
    linear_.row(i) = (coasting + h * fields_.drag_1_s * u_.row(i) - h * h * gravity) / w - h * h * stabilizing_.row(i);
  });
}

void ImplicitStage::assemble(const StageEquations& equations, bool projected) {
  const double h = equations.h_s;
  parallel_each(matrix_.rows(), [&](Eigen::Index i) {
    const double w = equations.inverse_mass[static_cast<std::size_t>(i)];
    matrix_.clear_row(i);
    SymmetricBlock diagonal = {};
    springs_.for_each_at(static_cast<VertexId>(i), [&](std::uint32_t s, double sign) {
      const SpringState& state = spring_[s];
      const double across_kg = projected ? std::max(0.0, state.across_kg) : state.across_kg;
      const auto add_spring = [&](double side, SymmetricBlock& block) {
        add_identity(side * across_kg, block);
        add_outer(side * (state.along_kg - across_kg), state.x, state.y, state.z, block);
      };
      SymmetricBlock off_diagonal = {};
      add_spring(1, diagonal);
      add_spring(-1, off_diagonal);
      matrix_.add_off_diagonal(entry_[2 * s + (sign > 0 ? 0 : 1)], off_diagonal);
    });
    if (w > 0) {
      const double speed_m = u_.row(i).norm();
      add_identity((1 + h * fields_.drag_1_s + fields_.quadratic_drag_1_m * speed_m) / w, diagonal);
      if (fields_.quadratic_drag_1_m > 0 && speed_m > 0) {
        add_outer(fields_.quadratic_drag_1_m / (w * speed_m), u_(i, 0), u_(i, 1), u_(i, 2), diagonal);
      }
    }
    matrix_.add_diagonal(i, diagonal);
    if (stabilizers_) stabilizers_->add_blocks(static_cast<VertexId>(i), h, matrix_);
  });
}

// Every term is found as a product with the step, not as a difference of potentials: small steps keep their digits.
ImplicitStage::Change ImplicitStage::potential_change(const StageEquations& equations, const Positions& x,
                                                      const Positions& step, double share) {
  const double h = equations.h_s;
  terms_.resize(spring_.size() + is_free_.size());
  parallel_each(static_cast<Eigen::Index>(spring_.size()), [&](Eigen::Index s) {
    const Spring& spring = springs_.springs()[static_cast<std::size_t>(s)];
    const SpringState& state = spring_[static_cast<std::size_t>(s)];
    const Eigen::RowVector3d d = x.row(spring.b) - x.row(spring.a);
    const Eigen::RowVector3d move = share * (step.row(spring.b) - step.row(spring.a));
    const double length = (d + move).norm(), lengths = length + state.length_m;
    const double growth = lengths > 0 ? move.dot(d + d + move) / lengths : 0;
    const Eigen::RowVector3d n(state.x, state.y, state.z);
    const double along = n.dot(move), before = n.dot(u_.row(spring.b) - u_.row(spring.a));
    terms_[static_cast<std::size_t>(s)] =
        h * h * spring.stiffness_n_m / 2 * growth * (lengths - 2 * spring.rest_length_m) +
        h * spring.damping_n_s_m / 2 * along * (2 * before + along);
  });
  Positions curvature = Positions::Zero(x.rows(), 3);  // of the part that is quadratic, times the step
  if (stabilizers_) stabilizers_->add_forces(step, -h * h, -h, curvature);
  parallel_each(x.rows(), [&](Eigen::Index i) {
    const double w = equations.inverse_mass[static_cast<std::size_t>(i)];
    double& term = terms_[spring_.size() + static_cast<std::size_t>(i)];
    term = 0;
    if (w == 0) return;
    const Eigen::RowVector3d move = share * step.row(i);
    term = move.dot(linear_.row(i) + share / 2 * curvature.row(i)) +
           (1 + h * fields_.drag_1_s) / (2 * w) * move.squaredNorm();
    if (fields_.quadratic_drag_1_m == 0) return;
    const double speed_m = u_.row(i).norm(), speed_after_m = (u_.row(i) + move).norm();
    term += fields_.quadratic_drag_1_m / (3 * w) * (std::pow(speed_after_m, 3) - std::pow(speed_m, 3));
  });
  Change change;
  const auto add = [&](const std::vector<double>& terms) {
    for (const double term : terms) {
      change.sum += term;
      change.magnitude += std::abs(term);
    }
  };
  add(terms_);
  if (equations.contacts != nullptr) {
    equations.contacts->changes(step, share, terms_);
    add(terms_);
  }
  return change;
}

double ImplicitStage::line_search(const StageEquations& equations, const Positions& x, const Positions& step) {
  const double slope = dot(gradient_, step);
  double share = 1;
  for (std::int32_t halvings = 0; halvings < kMaxHalvings; ++halvings, share /= 2) {
    const Change change = potential_change(equations, x, step, share);
    if (change.sum <= kDescent * share * slope + kSumRounding * change.magnitude) return share;
  }
  return 0;
}

double ImplicitStage::residual_m(const StageEquations& equations) const {
  double largest_m = 0;
  for (Eigen::Index i = 0; i < gradient_.rows(); ++i) {
    keep_largest(equations.inverse_mass[static_cast<std::size_t>(i)] * gradient_.row(i).norm(), largest_m);
  }
  return largest_m;
}

// What the rounding of positions makes of the residual: the matrix says how strongly it answers to them.
double ImplicitStage::rounding_m(const StageEquations& equations, const Positions& x) const {
  double strongest = 0;
  for (Eigen::Index i = 0; i < x.rows(); ++i) {
    SymmetricBlock diagonal = matrix_.diagonal(i);
    if (equations.contacts != nullptr) equations.contacts->add_diagonal(i, diagonal);
    strongest = std::max(strongest, equations.inverse_mass[static_cast<std::size_t>(i)] *
                                        std::max({diagonal[0], diagonal[3], diagonal[5]}));
  }
  return kForceRoundings * 0x1p-53 * x.cwiseAbs().maxCoeff() * strongest;
}

bool ImplicitStage::find_step(const StageEquations& equations, Positions& step, StageReport& report) {
  const double forcing = equations.contacts != nullptr ? kForcingInContact : kForcing;
  const ConjugateGradientsResult linear =
      linear_solver_.solve(matrix_, equations.contacts, is_free_, -gradient_, forcing, kMaxCgIterations, step);
  report.cg_iterations += linear.iterations;
  return linear.definite;
}

std::vector<double> ImplicitStage::resistance_kg(std::span<const double> inverse_mass, double h_s) const {
  std::vector<double> result(is_free_.size());
  for (VertexId i = 0; i < springs_.vertex_count(); ++i) {
    const double w = inverse_mass[static_cast<std::size_t>(i)];
    double sum = w > 0 ? 1 / w : 0;
    springs_.for_each_at(i, [&](std::uint32_t s, double) {
      const Spring& spring = springs_.springs()[s];
      sum += h_s * (h_s * spring.stiffness_n_m + spring.damping_n_s_m);
    });
    if (stabilizers_) sum += stabilizers_->resistance_kg(i, h_s);
    result[static_cast<std::size_t>(i)] = sum;
  }
  return result;
}

void ImplicitStage::fly_free(const StageEquations& equations, Positions& x) {
  const double h = equations.h_s;
  Positions in_flight = x, acceleration;
  parallel_each(x.rows(), [&](Eigen::Index i) {
    if (equations.inverse_mass[static_cast<std::size_t>(i)] == 0) return;
    const Eigen::RowVector3d v = equations.v_t0.row(i), kicked = v + h * fields_.gravity_m_s2.transpose();
    const double drag_1_s = fields_.drag_1_s + fields_.quadratic_drag_1_m * v.norm();
    in_flight.row(i) = equations.origin.row(i) + h / (1 + h * drag_1_s) * kicked;
  });
  if (stabilizers_) stabilizers_->look(equations.origin + h * equations.v_t0);
  find_forces(equations, x, acceleration);
  const double missing_m = residual_m(equations);
  find_forces(equations, in_flight, acceleration);
  if (residual_m(equations) < missing_m) x = in_flight;
}

StageReport ImplicitStage::solve(const StageEquations& equations, Positions& x, Positions& acceleration,
                                 double enough_m) {
  SELVAGE_ASSERT(equations.h_s > 0 && x.rows() == matrix_.rows());
  for (std::size_t i = 0; i < is_free_.size(); ++i) is_free_[i] = equations.inverse_mass[i] > 0 ? 1 : 0;
  if (stabilizers_) stabilizers_->look(equations.origin + equations.h_s * equations.v_t0);
  StageReport report;
  Positions step;
  for (;;) {
    find_forces(equations, x, acceleration);
    report.residual_m = residual_m(equations);
    if (report.newton_rounds == 0) report.first_residual_m = report.residual_m;
    report.converged = report.residual_m <= enough_m;
    if (report.converged) return report;
    assemble(equations, false);
    // Not the first guess: what stiff springs round away hides all that soft motions still lack.
    report.converged =
        report.newton_rounds > 0 && report.residual_m <= std::min(rounding_m(equations, x), kMaxRounding_m);
    if (report.converged || report.newton_rounds == kMaxRounds) return report;
    if (!find_step(equations, step, report)) {
      assemble(equations, true);
      (void)find_step(equations, step, report);
    }
    ++report.newton_rounds;
    const double share = line_search(equations, x, step);
    if (share == 0) return report;
    x += share * step;
  }
}

}  // namespace selvage::sim
