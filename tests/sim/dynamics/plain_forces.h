// The forces of springs and stabilisers, one spring after the other: what SpringLanes finds for several vertices at
// once.
#pragma once

#include <cmath>
#include <vector>

#include "sim/springs/spring_lanes.h"

namespace selvage::testing {

/// N; `magnitude` of row i is the sum of the magnitudes that were added up to it.
struct PlainForces {
  Positions elastic, damping;
  std::vector<double> elastic_magnitude, damping_magnitude;
};

/// Stabilisers are damped along their bows at `x_of_bows`.
inline PlainForces plain_forces(const sim::SpringSystem& springs, const std::vector<sim::Stabilizer>& stabilizers,
                                const Positions& x, const Positions& v, const Positions& x_of_bows) {
  const auto rows = static_cast<std::size_t>(x.rows());
  PlainForces sum{Positions::Zero(x.rows(), 3), Positions::Zero(x.rows(), 3), std::vector<double>(rows),
                  std::vector<double>(rows)};
  const auto add = [&](VertexId i, const Eigen::RowVector3d& elastic, const Eigen::RowVector3d& damping) {
    sum.elastic.row(i) += elastic;
    sum.damping.row(i) += damping;
    sum.elastic_magnitude[static_cast<std::size_t>(i)] += elastic.norm();
    sum.damping_magnitude[static_cast<std::size_t>(i)] += damping.norm();
  };
  for (const sim::Spring& spring : springs.springs()) {
    const Eigen::RowVector3d line = x.row(spring.b) - x.row(spring.a);
    const double length = line.norm();
    if (!(length > 0)) continue;
    const Eigen::RowVector3d n = line / length;
    const Eigen::RowVector3d pull = spring.stiffness_n_m * (length - spring.rest_length_m) * n;
    const Eigen::RowVector3d drag = spring.damping_n_s_m * n.dot(v.row(spring.b) - v.row(spring.a)) * n;
    add(spring.a, pull, drag);
    add(spring.b, -pull, -drag);
  }
  for (const sim::Stabilizer& s : stabilizers) {
    const Eigen::RowVector3d bow = bow_of(s, x).transpose(), along = bow_of(s, x_of_bows).transpose();
    const double squared = along.squaredNorm() + s.straight_m * s.straight_m;
    const double rate = squared > 0 ? along.dot(bow_of(s, v)) / squared : 0;
    const Eigen::RowVector3d drag = s.damping_n_s_m * rate * along;
    for (std::size_t k = 0; k < 4; ++k) {
      if (s.weights[k] != 0) add(s.vertices[k], -s.weights[k] * s.stiffness_n_m * bow, -s.weights[k] * drag);
    }
  }
  return sum;
}

inline PlainForces plain_forces(const sim::SpringSystem& springs, const std::vector<sim::Stabilizer>& stabilizers,
                                const Positions& x, const Positions& v) {
  return plain_forces(springs, stabilizers, x, v, x);
}

inline sim::LaneVectors to_lanes(const Positions& x) {
  sim::LaneVectors lanes;
  lanes.copy(x);
  return lanes;
}
inline Positions from_lanes(const sim::LaneVectors& lanes) {
  Positions x(lanes.rows(), 3);
  lanes.copy_to(x);
  return x;
}
inline sim::LaneScalars to_lanes(const std::vector<double>& values) {
  sim::LaneScalars lanes;
  lanes.copy(values);
  return lanes;
}

/// The same by SpringLanes.
struct LaneForces {
  Positions elastic, damping;
};
inline LaneForces lane_forces(const sim::SpringSystem& springs, const sim::StabilizerSystem* stabilizers,
                              const Positions& x, const Positions& v) {
  sim::SpringLanes lanes(springs, stabilizers);
  const sim::LaneVectors x_lanes = to_lanes(x), v_lanes = to_lanes(v);
  sim::LaneVectors force, impulses;
  const std::vector<double> inverse_mass(static_cast<std::size_t>(x.rows()), 1);
  lanes.set_shares({1, 0}, inverse_mass);
  lanes.look(x_lanes, force);
  lanes.multiply(x_lanes, v_lanes, impulses);
  return {from_lanes(force), -from_lanes(impulses)};
}

}  // namespace selvage::testing
