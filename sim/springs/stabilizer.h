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

/// A spring of rest length 0 between two material points: its vector, the bow, is sum_i weights[i] x_i, its energy k/2
/// |bow|^2. On a grid the points are the middle node and the midpoint of its two neighbours, {1, -1/2, -1/2}; on a
/// mesh they lie on an inner edge and on the line between the two vertices opposite it, where these cross when the pair
/// is unfolded.
///
/// It is damped as all springs are, along its line: by d n n^T times the rate of the bow, n = bow / |bow|, which a
/// rigid rotation does not change, and which has no torque. Where the bow is nearly straight n is what rounding makes
/// it, and damping fades: n n^T is bow bow^T / (|bow|^2 + straight_m^2).
struct Stabilizer {
  std::array<VertexId, 4> vertices{};  ///< different; unused ones have weight 0
  std::array<double, 4> weights{};     ///< sum 0
  double stiffness_n_m = 0;            ///< force per length of the bow
  double damping_n_s_m = 0;            ///< force per rate of that length
  double straight_m = 0;               ///< >= 0
};

/// The bow at x, or its rate at the velocities x.
[[nodiscard]] inline Vec3 bow_of(const Stabilizer& s, const Positions& x) {
  Vec3 bow = Vec3::Zero();
  for (std::size_t k = 0; k < 4; ++k) {
    if (s.weights[k] != 0) bow += s.weights[k] * x.row(s.vertices[k]).transpose();
  }
  return bow;
}

/// Stabilisers with the list of those at each vertex, and the sum of their elastic forces as constant coefficients c_ij
/// of pairs: the force on i is sum_j c_ij (x_i - x_j) with c_ij = c_ji to the bit. Each pair's forces are opposite and
/// along the line between the vertices, so both momenta are kept to rounding. Deterministic for any thread count.
class StabilizerSystem {
 public:
  StabilizerSystem() = default;
  /// REQUIRES vertices with weight in [0, vertex_count).
  StabilizerSystem(std::vector<Stabilizer> stabilizers, std::int32_t vertex_count);

  [[nodiscard]] bool empty() const { return stabilizers_.empty(); }
  [[nodiscard]] const std::vector<Stabilizer>& stabilizers() const { return stabilizers_; }

  /// What a vertex is to a stabiliser.
  struct End {
    std::int32_t stabilizer, point;  ///< vertices[point] of it
  };
  /// Those at vertex i, in the order of their numbers; none where there are no stabilisers at all.
  [[nodiscard]] std::span<const End> ends_at(VertexId i) const { return ends_.row(i); }

  /// The stiffness of a pair of vertices.
  struct Neighbour {
    VertexId vertex;
    double coefficient_n_m;  ///< c_ij
  };
  /// Those of vertex i, in increasing order.
  [[nodiscard]] std::span<const Neighbour> neighbours_of(VertexId i) const { return neighbours_.row(i); }
  /// Sum of the magnitudes of row i of their matrix: Gershgorin's bound.
  [[nodiscard]] double row_sum_n_m(VertexId i) const;

 private:
  template <class Item>
  struct Rows {
    std::vector<std::size_t> begin{0};  ///< those of vertex i are items[begin[i] .. begin[i + 1])
    std::vector<Item> items;
    [[nodiscard]] std::span<const Item> row(VertexId i) const {
      if (items.empty()) return {};
      const auto at = static_cast<std::size_t>(i);
      return {items.data() + begin[at], begin[at + 1] - begin[at]};
    }
  };

  std::vector<Stabilizer> stabilizers_;
  Rows<End> ends_;
  Rows<Neighbour> neighbours_;
};

}  // namespace selvage::sim
