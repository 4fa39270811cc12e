// Implicit dynamics for stiff cloth at large steps: the same springs as the paper's, another time integration.
#pragma once

#include "sim/dynamics/dynamics.h"
#include "sim/dynamics/implicit_stage.h"
#include "sim/springs/strain.h"

namespace selvage::sim {

struct StageSpan;

struct ImplicitDynamicsOptions {
  FieldForces fields;
  StrainLimits strain;                            ///< of which strain_rate is not used
  double step_s = 0;                              ///< longest internal step; REQUIRES > 0
  const StabilizerSystem* stabilizers = nullptr;  ///< none, or outlives the dynamics
};

/// The singly diagonally implicit Runge-Kutta method with two stages of second order that is L-stable (Alexander 1977;
/// Hairer and Wanner 1996, IV.6), with g = 1 - 1/sqrt(2):
///   x1 = x + g h v1,                    v1 = v + g h a(x1, v1);
///   x2 = x + (1 - g) h v1 + g h v2,     v2 = v + (1 - g) h a(x1, v1) + g h a(x2, v2);   x(n+1) = x2, v(n+1) = v2.
/// No step is too long to be stable, what is too stiff for the step to resolve is damped at once (backward Euler damps
/// all the rest as well; the trapezoidal rule lets stiff springs ring), and of free motion nothing is remembered from
/// one step to the next, so contact and changes of the step need no restart. Velocities are those of the forces found,
/// which are equal and opposite: linear momentum is kept to rounding, angular momentum to the order of the method.
///
/// A step within which drag stops something is one of backward Euler, which no drag turns round; so is that of cloth
/// that hangs together, by faces or contacts, with what is in contact, x1 = x + h v1, v1 = v + h a(x1, v1), with the
/// contacts in its potential (stage_contacts.h): of the two stages the second would throw back at (1 - g) / g = 2.4
/// times its speed what meets something in between. It is of first order. What contacts bear is found to a
/// ten-thousandth of the largest of it, or as far as some dozen solutions find it, more where contacts begin to slide;
/// it begins with what they bore in the last step, friction and edges as well.
class ImplicitDynamics : public Dynamics {
 public:
  ImplicitDynamics(const SpringSystem& springs, const ImplicitDynamicsOptions& options);  ///< springs outlive it

  /// As many equal internal steps as options.step_s asks for. Where some cloth is in contact and some is not, each is
  /// solved for with the other held, which takes a solution of all more than without contact. Where one would break the
  /// strain limit of section 4, its mean velocity is changed as the limit says, and that at its end by as much. The
  /// limit on the strain rate is not used: it is for explicit springs, and it keeps stiff ones that contact has
  /// stretched from coming back (the demo with 25 x 25 vertices, springs of 6,000 N/m and steps of 1/240 s held at most
  /// 5 J of elastic energy without it, and 1,100 J after 0.9 s with it).
  DynamicsReport advance(Motion& motion, const PositionsRef& scripted_x_t1, std::span<const double> inverse_mass,
                         double dt_s, HeldContacts* contacts = nullptr) override;
  [[nodiscard]] bool holds_contacts(double, const PositionsRef&) const override { return true; }

  /// Adds to the velocity at the end what the collision step changed in the mean velocity. REQUIRES advance() before.
  void final_velocity(Motion& motion, std::span<const double> inverse_mass, double dt_s) override;

 private:
  [[nodiscard]] bool brakes(const Positions& v, std::span<const double> inverse_mass, double h) const;
  void step(Motion& motion, std::span<const double> inverse_mass, double h, DynamicsReport& report);
  void step_in_contact(Motion& motion, std::span<const double> inverse_mass, const StageSpan& span,
                       HeldContacts& contacts, DynamicsReport& report);
  /// Finds where the cloth goes and what its contacts bear, from the guesses that x and the contacts hold.
  StageReport solve_in_contact(const StageEquations& equations, Positions& x);
  void limit(const Positions& x_t0, std::span<const double> inverse_mass, double h, Motion& motion);

  double step_s_;
  StrainLimiter strain_;
  ImplicitStage stage_;
  Positions acceleration_;
  Positions end_v_, average_v_;  ///< of the last advance(), m/s
  LaneVectors x_t0_, x_t1_, mean_v_;
};

}  // namespace selvage::sim
