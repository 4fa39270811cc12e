// The internal dynamics of cloth behind one interface: where it would go if there were no contact (paper, section 5).
#pragma once

#include <span>

#include "kernel/types.h"

namespace selvage::sim {

/// Positions and velocities of the cloth's vertices, rows [0, cloth vertex count).
struct Motion {
  Positions x;  ///< m
  Positions v;  ///< m/s
};

class Dynamics {
 public:
  virtual ~Dynamics() = default;

  /// Advances `motion` by dt_s without any contact. Vertices with inverse mass 0 move on a straight line to their row
  /// of `scripted_x_t1`, whose other rows are not read.
  virtual void advance(Motion& motion, const PositionsRef& scripted_x_t1, std::span<const double> inverse_mass,
                       double dt_s) = 0;

  /// Section 7.6: the velocity at the end of a step with contacts, from the positions there and the midstep velocity
  /// that the collision step left in motion.v. Rows with inverse mass 0 are kept.
  virtual void final_velocity(Motion& motion, std::span<const double> inverse_mass, double dt_s) = 0;
};

}  // namespace selvage::sim
