// The forces of springs and stabilisers on several vertices at once (SIMD, chosen at run time): elastic forces, and
// products with the matrix of damping.
#pragma once

#include <vector>

#include "sim/base/lane_table.h"
#include "sim/springs/impulse_shares.h"
#include "sim/springs/spring.h"
#include "sim/springs/stabilizer_lanes.h"

namespace selvage::sim {

/// What a spring does, by entry of a table, and the elastic forces of stabilisers between the same two vertices.
struct SpringEntries {
  std::vector<double> pull_n_m, slack_pull_n;  ///< of both, force by length; of the spring, less at any length
  std::vector<double> stiffness_n_m, damping_n_s_m;
  std::vector<double> along;  ///< of the springs in B, by length squared; set by look()
};

/// Every spring is looked at from both its ends, which find the same bits with opposite signs: forces and impulses are
/// equal and opposite along the line between the ends, so momenta are kept to rounding. Each vertex sums up in an order
/// that does not change: same bits for any thread count and vector unit.
class SpringLanes {
 public:
  /// `stabilizers` may be null; neither is needed later on.
  SpringLanes(const SpringSystem& springs, const StabilizerSystem* stabilizers);

  /// B is that of `shares` from now on.
  void set_shares(const ImpulseShares& shares, std::span<const double> inverse_mass);
  /// Looks at the springs at x: `force` becomes the elastic forces in N, and B is that at x from now on. Two vertices
  /// at the same place, or so near that their squared distance is subnormal, do not pull at each other.
  void look(const LaneVectors& x, LaneVectors& force);

  /// B v: row i is the sum over its springs of c n n^T (v_i - v_other) with c = damping_s d + stiffness_s2 k, and what
  /// stabilisers add (stabilizer_lanes.h). B is symmetric and positive semidefinite, and its rows sum to zero. REQUIRES
  /// the x that look() saw last.
  void multiply(const LaneVectors& x, const LaneVectors& v, LaneVectors& product);
  /// The same in two parts, for who goes on with rows while they are at hand: all of v is looked at, then rows [begin,
  /// end) are found, in any order. REQUIRES begin a multiple of kLanes.
  void begin_product(const LaneVectors& x, const LaneVectors& v) { stabilizers_.oppose(x, v); }
  /// Where v corrects what the last product was of, and stabilisers are weak, they are left out.
  void begin_correction(const LaneVectors& x, const LaneVectors& v) { stabilizers_.oppose_correction(x, v); }
  void multiply_rows(const LaneVectors& x, const LaneVectors& v, Eigen::Index begin, Eigen::Index end,
                     LaneVectors& product) const;

  /// The diagonal of B.
  [[nodiscard]] const LaneVectors& diagonal() const { return diagonal_; }

  /// The sum of the magnitudes of row i of B, whatever the directions: Gershgorin's bound.
  [[nodiscard]] double row_sum(VertexId i) const;

 private:
  LaneTable table_;
  SpringEntries entries_;
  StabilizerLanes stabilizers_;
  ImpulseShares shares_;
  LaneVectors diagonal_;
};

}  // namespace selvage::sim
