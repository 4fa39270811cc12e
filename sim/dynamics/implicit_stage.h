// One implicit stage: positions whose velocity and forces are those at its own end (backward Euler), by Newton's
// method.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "sim/base/conjugate_gradients.h"
#include "sim/dynamics/field_forces.h"
#include "sim/dynamics/stage_stabilizers.h"
#include "sim/springs/spring.h"

namespace selvage::sim {

class StageContacts;

/// What the equations of a stage are: find x with v = (x - origin) / h and v = v_t0 + h a(x, v).
struct StageEquations {
  const Positions& origin;  ///< m
  const Positions& v_t0;    ///< m/s
  std::span<const double> inverse_mass;
  double h_s = 0;                     ///< > 0
  StageContacts* contacts = nullptr;  ///< none, or looked at anew where the solution goes
};

/// What a solution is worth.
struct StageReport {
  std::int32_t newton_rounds = 0, cg_iterations = 0;
  /// The largest |x - origin - h v_t0 - h^2 a| of a vertex, in m: how far it is from where its forces put it.
  double first_residual_m = 0, residual_m = 0;  ///< of the first guess, and of the solution
  bool converged = false;
};

/// Newton's method on the potential whose minimum the stage is:
///   sum of m/2 |u|^2 - m u.(h v_t0 + h^2 g) + m h drag/2 |u|^2 + m quadratic_drag/3 |u|^3 + h^2 (spring energies)
/// and of the contacts' terms, u = x - origin. Damping forces join it with the directions of the springs that each
/// round starts from, and of stabilisers where their velocity takes them. The matrix of a round is the potential's
/// second derivative, and what damping pulls across springs that turn. Compressed springs push across themselves: where
/// that makes it not positive definite, which conjugate gradients find out, the part across is left out of them for the
/// round (the usual projection; with it alone buckled cloth converges by a quarter a round). So every solution is a
/// direction of descent, and a step that does not lower the potential is halved.
class ImplicitStage {
 public:
  /// `stabilizers` may be null; both outlive the stage.
  ImplicitStage(const SpringSystem& springs, const StabilizerSystem* stabilizers, const FieldForces& fields);

  /// x holds the first guess, and the given positions of vertices with inverse mass 0, which are kept. It ends where
  /// the equations hold within enough_m, or, after a round, within what rounding leaves up to kMaxRounding_m, or
  /// after kMaxRounds: then it is the best that was found, and the report says so. `acceleration` becomes a(x, v),
  /// without that of the vertices held, and with that of the contacts.
  StageReport solve(const StageEquations& equations, Positions& x, Positions& acceleration,
                    double enough_m = kResidual_m);
  /// Takes x, as solve() does, to where cloth that meets nothing comes to, if less is missing there. From rest the
  /// first solutions of a stage, which are rough, distort what flies; pairs that are at their limit at rest are pressed
  /// by that, with friction, and thick cloth lost a tenth of its velocity to it. From free flight always, stiff cloth
  /// that meets something takes longer (docs/measurements/numerics.md).
  void fly_free(const StageEquations& equations, Positions& x);
  [[nodiscard]] const FieldForces& fields() const { return fields_; }
  /// #V: a bound of the matrix's diagonal at each vertex without contacts and drag, kg.
  [[nodiscard]] std::vector<double> resistance_kg(std::span<const double> inverse_mass, double h_s) const;

  static constexpr std::int32_t kMaxRounds = 50;
  /// A thousandth of the default collision tolerance. In velocity it is an error of 1e-9 m / h.
  static constexpr double kResidual_m = 1e-9;
  /// What cloth falls in a frame of 1/30 s: where rounding leaves more than that, nothing was solved.
  static constexpr double kMaxRounding_m = 5e-3;

 private:
  // A spring where it was last looked at: direction, length, pull along it, and its second derivatives times h^2.
  struct SpringState {
    double x, y, z, length_m, pull_n, along_kg, across_kg;
  };
  // Of the potential, and the sum of the magnitudes that it was added up from: for what rounding may do to it.
  struct Change {
    double sum = 0, magnitude = 0;
  };

  void find_forces(const StageEquations& equations, const Positions& x, Positions& acceleration);
  /// `projected`: without the part of compressed springs across themselves.
  void assemble(const StageEquations& equations, bool projected);
  /// Solves a round's linear equations. False where the matrix is not positive definite.
  bool find_step(const StageEquations& equations, Positions& step, StageReport& report);
  /// The share of `step` to take, from 1 downwards; 0 where none lowers the potential.
  [[nodiscard]] double line_search(const StageEquations& equations, const Positions& x, const Positions& step);
  [[nodiscard]] Change potential_change(const StageEquations& equations, const Positions& x, const Positions& step,
                                        double share);
  [[nodiscard]] double residual_m(const StageEquations& equations) const;
  [[nodiscard]] double rounding_m(const StageEquations& equations, const Positions& x) const;

  const SpringSystem& springs_;
  std::optional<StageStabilizers> stabilizers_;
  FieldForces fields_;
  BlockMatrix matrix_;
  std::vector<std::size_t> entry_;  ///< of both ends of every spring: its block in matrix_, in the row of end a, then b
  ConjugateGradients linear_solver_;
  std::vector<std::uint8_t> is_free_;
  // What find_forces() found, at the positions it was given last.
  std::vector<SpringState> spring_;
  Positions u_;                  ///< x - origin
  Positions gradient_, linear_;  ///< of the potential, kg m; the second without springs and quadratic drag
  Positions stabilizing_;        ///< force of the stabilisers, N
  std::vector<double> terms_;
};

}  // namespace selvage::sim
