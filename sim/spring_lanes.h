// The forces of springs and stabilisers on several vertices at once (SIMD, chosen at run time): elastic forces, and
// products with the matrix of damping.
#pragma once

#include <vector>

#include "sim/lane_table.h"
#include "sim/spring.h"
#include "sim/stabilizer.h"

namespace selvage::sim {

/// How much of each matrix there is in B, which maps velocities to the impulses that oppose them: damping over a time,
/// and stiffness where velocities displace the ends.
struct ImpulseShares {
  double damping_s = 0, stiffness_s2 = 0;
};

/// What a spring and a stabiliser between the same two vertices do, by entry of a table. The coefficients of
/// stabilisers are those of pairs, of either sign.
struct SpringEntries {
  std::vector<double> pull_n_m, slack_pull_n;  ///< of both, force by length; of the spring, less at any length
  std::vector<double> stiffness_n_m, damping_n_s_m;
  std::vector<double> stabilizing_n_m, stabilizing_n_s_m;
  std::vector<double> along;  ///< of the springs in B, by length squared; set by look()
  std::vector<double> all_stabilizing_n_m, all_stabilizing_n_s_m;  ///< sums by vertex, in whole blocks
};

/// Every spring is looked at from both its ends, which find the same bits with opposite signs: forces and impulses are
/// equal and opposite along the line between the ends, so momenta are kept to rounding. Each vertex sums up in an order
/// that does not change: same bits for any thread count and vector unit.
class SpringLanes {
 public:
  /// `stabilizers` may be null; neither is needed later on.
  SpringLanes(const SpringSystem& springs, const StabilizerSystem* stabilizers);

  /// Looks at the springs at x: `force` becomes the elastic forces in N, and B is that of `shares` from now on. Two
  /// vertices at the same place, or so near that their squared distance is subnormal, do not pull at each other.
  void look(const LaneVectors& x, const ImpulseShares& shares, LaneVectors& force);

  /// Rows [begin, end) of B v: row i is the sum over its springs of c n n^T (v_i - v_other) with c = damping_s d +
  /// stiffness_s2 k, and the same of the stabilisers without n n^T. B is symmetric and positive semidefinite, and its
  /// rows sum to zero. REQUIRES the x that look() saw last, and begin a multiple of kLanes.
  void multiply(const LaneVectors& x, const LaneVectors& v, Eigen::Index begin, Eigen::Index end,
                LaneVectors& product) const;
  void multiply(const LaneVectors& x, const LaneVectors& v, LaneVectors& product) const;  ///< all rows

  /// The diagonal of B.
  [[nodiscard]] const LaneVectors& diagonal() const { return diagonal_; }

  /// The sum of the magnitudes of row i of B, whatever the directions: Gershgorin's bound.
  [[nodiscard]] double row_sum(VertexId i) const;

 private:
  LaneTable table_;
  SpringEntries entries_;
  ImpulseShares shares_;
  LaneVectors diagonal_;
};

}  // namespace selvage::sim
