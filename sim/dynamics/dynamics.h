// The internal dynamics of cloth behind one interface: where it would go with the contacts that are known beforehand,
// if there are any (paper, section 5).
#pragma once

#include <span>

#include "kernel/types.h"

namespace selvage::sim {

class HeldContacts;

/// Positions and velocities of the cloth's vertices, rows [0, cloth vertex count).
struct Motion {
  Positions x;  ///< m
  Positions v;  ///< m/s
};

/// How well an implicit solver did; all zero where nothing is solved.
struct DynamicsReport {
  std::int32_t solves = 0;         ///< systems of equations; with contacts solved several times, each counts once
  std::int32_t newton_rounds = 0;  ///< over all of them
  std::int32_t cg_iterations = 0;
  std::int32_t unconverged = 0;  ///< solves that ended above their tolerance: the best that was found was taken
  double residual_m = 0;         ///< the largest of all solves
};

class Dynamics {
 public:
  virtual ~Dynamics() = default;

  /// Advances `motion` by dt_s without any contact but `contacts`, if there are any. Vertices with inverse mass 0 move
  /// on a straight line to their row of `scripted_x_t1`, whose other rows are not read.
  virtual DynamicsReport advance(Motion& motion, const PositionsRef& scripted_x_t1,
                                 std::span<const double> inverse_mass, double dt_s,
                                 HeldContacts* contacts = nullptr) = 0;
  /// Whether contacts act in advance() from x.
  [[nodiscard]] virtual bool holds_contacts(double dt_s, const PositionsRef& x) const = 0;

  /// Section 7.6: the velocity at the end of a step with contacts, from the positions there and the mean velocity
  /// that the collision step left in motion.v. Rows with inverse mass 0 are kept.
  virtual void final_velocity(Motion& motion, std::span<const double> inverse_mass, double dt_s) = 0;
};

}  // namespace selvage::sim
