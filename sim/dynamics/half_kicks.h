// What forces change of velocities in half a step of the dynamics (paper, section 5), for several vertices at once
// (SIMD, chosen at run time).
#pragma once

#include "sim/base/lane_vectors.h"
#include "sim/dynamics/field_forces.h"

namespace selvage::sim {

struct HalfKick {
  double h = 0;  ///< of the whole step, s
  FieldForces fields;
};

// Vertices without inverse mass keep their velocity. All of it is found vertex by vertex: same bits for any thread
// count and vector unit.

/// Half a step of the elastic `force`, N, gravity, drag, and `impulses`, N s, that are taken from v. Drag that is
/// strong beside the step brakes all of it so that it turns no velocity round. `x_t1` becomes where v takes x then.
void explicit_half_kick(const HalfKick& kick, const LaneScalars& inverse_mass, const LaneVectors& force,
                        const LaneVectors& impulses, const LaneVectors& x, LaneVectors& v, LaneVectors& x_t1);

/// `kicked` becomes v after half a step of what does not depend on it: the elastic force and gravity.
void elastic_half_kick(const HalfKick& kick, const LaneScalars& inverse_mass, const LaneVectors& force,
                       const LaneVectors& v, LaneVectors& kicked);

}  // namespace selvage::sim
