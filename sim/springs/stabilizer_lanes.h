// What stabilisers oppose to velocities, for several of them at once (SIMD, chosen at run time).
#pragma once

#include <span>
#include <vector>

#include "sim/base/lane_table.h"
#include "sim/springs/impulse_shares.h"
#include "sim/springs/stabilizer.h"

namespace selvage::sim {

/// What stabilisers are, in whole blocks of them.
struct StabilizerColumns {
  std::vector<double> stiffness_n_m, damping_n_s_m;
  std::vector<double> straight_m2;  ///< squared
};

/// Their part of B (spring_lanes.h): the sum of c n n^T between their material points, with n n^T that of Stabilizer
/// and c = damping_s d + stiffness_s2 k, as of a spring along the bow. So impulses have no torque, and keep both
/// momenta to rounding. Each vertex sums up in an order that does not change: same bits for any thread count and vector
/// unit.
class StabilizerLanes {
 public:
  StabilizerLanes() = default;
  StabilizerLanes(const StabilizerSystem& stabilizers, std::int32_t vertex_count);  ///< not needed later on

  /// B is that of `shares` from now on.
  void set_shares(const ImpulseShares& shares, std::span<const double> inverse_mass);
  /// Adds the diagonal of B at x, unless B is weak.
  void add_diagonal(const LaneVectors& x, LaneVectors& diagonal);
  /// Finds what each at x opposes to v. add_product() adds rows [begin, end) of B v, of that v; begin is a multiple of
  /// kLanes.
  void oppose(const LaneVectors& x, const LaneVectors& v);
  /// The same for a correction of v, to which they answer nothing where they are weak: where they oppose less than a
  /// 32nd of the momentum that there is.
  void oppose_correction(const LaneVectors& x, const LaneVectors& v);
  void add_product(Eigen::Index begin, Eigen::Index end, LaneVectors& product) const;
  /// At least the sum of the magnitudes of row i of B, whatever the directions.
  [[nodiscard]] double row_sum(VertexId i) const;

 private:
  enum class Strength { kNone, kWeak, kFull };
  [[nodiscard]] Strength find_strength(std::span<const double> inverse_mass) const;

  LaneTable points_, ends_;                        ///< the vertices of a stabiliser; the stabilisers at a vertex
  std::vector<double> point_weight_, end_weight_;  ///< by entry of both
  StabilizerColumns columns_;
  std::vector<double> row_sum_n_m_, row_sum_n_s_m_;  ///< by vertex
  ImpulseShares shares_;
  Strength strength_ = Strength::kNone;  ///< of B
  bool answers_ = false;                 ///< to what was to be opposed last
  LaneVectors scaled_bow_;               ///< by stabiliser: sqrt(c) n
  LaneVectors impulse_;                  ///< by stabiliser, on the middle node
};

}  // namespace selvage::sim
