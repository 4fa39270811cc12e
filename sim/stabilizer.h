// Stabilisation springs: each pulls a middle node back between the ends of a bending spring (paper, section 3). A
// bending spring has two rest states, one folded to either side; the stabiliser has one, the flat one, and no singular
// direction.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "kernel/types.h"

namespace selvage::sim {

/// A spring of rest length 0 between two material points: its vector is sum_i weights[i] x_i, its energy k/2
/// |vector|^2. On a grid the points are the middle node and the midpoint of its two neighbours, {1, -1/2, -1/2}; on a
/// mesh they lie on an inner edge and on the line between the two vertices opposite it, where these cross when the pair
/// is unfolded.
struct Stabilizer {
  std::array<VertexId, 4> vertices{};  ///< different; unused ones have weight 0
  std::array<double, 4> weights{};     ///< sum 0
  double stiffness_n_m = 0;            ///< force per length of the vector
  double damping_n_s_m = 0;            ///< force per rate of the vector
};

/// The sum of all stabilisers, as constant coefficients c_ij of pairs: the force on i is sum_j c_ij (x_i - x_j) with
/// c_ij = c_ji to the bit. Each pair's forces are opposite, so linear momentum is kept to rounding, and angular
/// momentum by the elastic part, which acts along the line between the vertices. Damping does not: where its vector is
/// not 0 a stabiliser is damped in a rigid rotation as well (docs/numerics.md). Deterministic for any thread count.
class StabilizerSystem {
 public:
  StabilizerSystem() = default;
  /// REQUIRES vertices with weight in [0, vertex_count).
  StabilizerSystem(std::span<const Stabilizer> stabilizers, std::int32_t vertex_count);

  [[nodiscard]] bool empty() const { return neighbours_.empty(); }
  [[nodiscard]] std::int32_t count() const { return count_; }

  /// Adds minus (stiffness_share K + damping_share D) X to rows [0, vertex_count) of `result`: elastic forces at X with
  /// shares (1, 0), damping forces at the velocities X with (0, 1).
  void add_forces(const Positions& X, double stiffness_share, double damping_share, Positions& result) const;
  /// What it adds to row i.
  [[nodiscard]] Eigen::RowVector3d force_at(const Positions& X, VertexId i, double stiffness_share,
                                            double damping_share) const {
    if (empty()) return Eigen::RowVector3d::Zero();
    const auto row = static_cast<std::size_t>(i);
    const double* const X_i = X.data() + 3 * std::ptrdiff_t{i};
    const double x_i = X_i[0], y_i = X_i[1], z_i = X_i[2];
    double x = 0, y = 0, z = 0;
    for (std::size_t n = begin_[row]; n < begin_[row + 1]; ++n) {
      const Neighbour& neighbour = neighbours_[n];
      const double* const X_j = X.data() + 3 * std::ptrdiff_t{neighbour.vertex};
      const double c = stiffness_share * neighbour.stiffness + damping_share * neighbour.damping;
      x += c * (x_i - X_j[0]);
      y += c * (y_i - X_j[1]);
      z += c * (z_i - X_j[2]);
    }
    return {x, y, z};
  }
  /// Element (i, i) of stiffness_share K + damping_share D, one for all three axes.
  [[nodiscard]] double diagonal(VertexId i, double stiffness_share, double damping_share) const;
  /// Sum of the magnitudes of row i of the same matrix: Gershgorin's bound.
  [[nodiscard]] double row_sum(VertexId i, double stiffness_share, double damping_share) const;
  /// Calls visit(j, stiffness, damping) with both parts of c_ij for every j that vertex i shares a stabiliser with, in
  /// increasing order.
  template <class Visit>
  void for_each_at(VertexId i, Visit visit) const {
    if (empty()) return;
    const auto row = static_cast<std::size_t>(i);
    for (std::size_t n = begin_[row]; n < begin_[row + 1]; ++n) {
      visit(neighbours_[n].vertex, neighbours_[n].stiffness, neighbours_[n].damping);
    }
  }

 private:
  struct Neighbour {
    VertexId vertex;
    double stiffness, damping;  ///< c_ij
  };
  std::int32_t count_ = 0;
  std::vector<std::size_t> begin_;  ///< those of vertex i are neighbours_[begin_[i] .. begin_[i + 1])
  std::vector<Neighbour> neighbours_;
};

}  // namespace selvage::sim
