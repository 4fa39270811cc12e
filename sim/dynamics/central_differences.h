// The paper's dynamics: springs, gravity and drag by central differencing, with limits on strain (sections 3 to 5).
#pragma once

#include <cmath>
#include <limits>

#include "sim/dynamics/dynamics.h"
#include "sim/dynamics/half_kicks.h"
#include "sim/dynamics/velocity.h"
#include "sim/springs/spring_lanes.h"
#include "sim/springs/strain.h"

namespace selvage::sim {

struct CentralDifferencesOptions {
  FieldForces fields;  ///< where drag is quadratic, the velocity marches (velocity_march.h) instead of being solved for
  StrainLimits strain;
  double step_s = 0;  ///< longest internal step; REQUIRES > 0 and below stable_step_s()
  /// stable_step_s() of the springs. Where contacts are held, and a spring is longer by more than 0.3, internal steps
  /// are at most 0.9 of this over its length in units of that at rest, or 0.35 of it. REQUIRES > 0
  double stable_step_s = std::numeric_limits<double>::infinity();
  const StabilizerSystem* stabilizers = nullptr;  ///< none, or outlives the dynamics
};

/// Explicit in the elastic forces, implicit in damping in the second half step (paper, sections 5 and 7.6):
///   v(n+1/2) = v(n) + h/2 a(x(n), v(n));  x(n+1) = x(n) + h v(n+1/2);  v(n+1) = v(n+1/2) + h/2 a(x(n+1), v(n+1)).
/// Between the first two lines the limits of section 4 act on v(n+1/2). Drag that is strong beside the step brakes the
/// first line so that it turns no velocity round; of second order all the same.
class CentralDifferences : public Dynamics {
 public:
  CentralDifferences(const SpringSystem& springs, const CentralDifferencesOptions& options);  ///< springs outlive it

  /// As many equal internal steps as the options ask for.
  DynamicsReport advance(Motion& motion, const PositionsRef& scripted_x_t1, std::span<const double> inverse_mass,
                         double dt_s, HeldContacts* contacts = nullptr) override;
  /// Where the collision step is made of several internal ones: one that is one leaves contacts to the repulsions,
  /// which are the same then.
  [[nodiscard]] bool holds_contacts(double dt_s, const PositionsRef& x) const override {
    return step_count_in_contact(dt_s, x) > 1;
  }

  /// v(n+1) of the line above. After an advance() in several internal steps the collision step has changed an average
  /// velocity; the cloth's own at the end of the step is another, which the average must not take the place of: where
  /// springs swing by some half a turn in a step, that put energy in (two undamped sheets in contact gained 1.7 times
  /// their kinetic energy, and none since). So the change alone is added to the last midstep velocity, and the kick is
  /// that of the last internal step. Without an advance() before, h = dt_s and motion.v is the midstep velocity itself.
  /// That may be longer than what is stable for explicit springs, so here they act where the velocity carries the ends
  /// in half a step: (h/2)^2 k n n^T is added to the matrix. For h within the stable step this is a correction of
  /// second order in the step; over time it damps cloth in contact, the more the shorter collision steps are
  /// (docs/measurements/numerics.md, *After contact*). For longer ones it is what keeps it bounded. Forces stay along
  /// the springs, so angular momentum is kept. (A part across springs in tension did not keep it, by 6e-8 of it a step,
  /// and table-legs was as calm without.)
  void final_velocity(Motion& motion, std::span<const double> inverse_mass, double dt_s) override;

 private:
  [[nodiscard]] static int step_count(double dt_s, double longest_s) {
    return static_cast<int>(std::ceil(dt_s / longest_s));
  }
  [[nodiscard]] int step_count_in_contact(double dt_s, const PositionsRef& x) const;
  /// Leaves the impulses of B at the new velocity in impulses_.
  void implicit_half_kick(double h, double residual);
  void march(const VelocitySystem& system, double time_s);
  /// The relative residual at which the solution for the velocity ends, for the shares that the springs have.
  [[nodiscard]] double velocity_residual() const;

  CentralDifferencesOptions options_;
  const SpringSystem& system_;
  SpringLanes springs_;
  LaneScalars inverse_mass_;
  LaneVectors x_, v_;
  LaneVectors force_;     ///< elastic, at x_
  LaneVectors impulses_;  ///< of damping over half a step, at the last velocity
  LaneVectors rhs_, x_t1_;
  double internal_step_s_ = 0;  ///< of the last advance(); 0: there was none
  LaneVectors last_midstep_v_;  ///< of its last internal step
  Positions average_v_;         ///< over all of it
  VelocitySolver solver_;
  StrainLimiter strain_;
};

}  // namespace selvage::sim
