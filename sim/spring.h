// Springs between pairs of vertices, and their elastic and damping forces (paper, section 3).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "kernel/types.h"
#include "sim/stabilizer.h"

namespace selvage::sim {

enum class SpringKind : std::uint8_t {
  kStructural,  ///< neighbours along the grid, or the edges of a general mesh
  kShear,       ///< both diagonals of a grid square
  kBending,     ///< every other node of a grid, or the two vertices opposite an inner edge; no strain limit (section 4)
};

struct Spring {
  VertexId a = 0, b = 0;
  SpringKind kind = SpringKind::kStructural;
  double rest_length_m = 0;
  double stiffness_n_m = 0;  ///< force per elongation
  double damping_n_s_m = 0;  ///< force per rate of elongation
};

/// Springs with the list of those that end at each vertex, so that forces are gathered per vertex in a fixed order.
class SpringSystem {
 public:
  /// REQUIRES ends in [0, vertex_count) and a != b.
  SpringSystem(std::vector<Spring> springs, std::int32_t vertex_count);

  [[nodiscard]] const std::vector<Spring>& springs() const { return springs_; }
  [[nodiscard]] std::int32_t vertex_count() const { return static_cast<std::int32_t>(begin_.size()) - 1; }

  /// Rows [0, vertex_count) of `force` become the elastic forces at x, in N. Each spring pulls its two ends with the
  /// same number of opposite sign, along the line between them, so linear and angular momentum are kept to rounding. A
  /// spring of length 0 has no direction and pulls at neither end. Deterministic for any thread count.
  void elastic_forces(const PositionsRef& x, Positions& force) const;

  /// Unit vectors from a to b of every spring at x; zero for a spring of length 0.
  void directions(const PositionsRef& x, Positions& direction) const;

  /// Row i of `result` becomes sum over the springs s at i of coefficient[s] n_s n_s^T (v_i - v_other): the product
  /// with a symmetric positive semidefinite matrix whose rows sum to zero. With the damping coefficients it is minus
  /// the damping force. `scratch` is room to work in.
  void apply(const Positions& direction, std::span<const double> coefficient, const Positions& v, Positions& result,
             Positions& scratch) const;

  /// Calls visit(spring index, other end, sign) for the springs at vertex i in a fixed order; sign is +1 where i is a.
  template <class Visit>
  void for_each_at(VertexId i, Visit visit) const {
    for (auto k = begin_[static_cast<std::size_t>(i)]; k < begin_[static_cast<std::size_t>(i) + 1]; ++k) {
      visit(ends_[k].spring, ends_[k].sign);
    }
  }

 private:
  struct End {
    std::uint32_t spring;
    double sign;
  };
  std::vector<Spring> springs_;
  std::vector<std::size_t> begin_;  ///< the ends at vertex i are ends_[begin_[i] .. begin_[i + 1])
  std::vector<End> ends_;
};

/// The largest step for which central differencing of these springs is stable: 2 / omega, where the squared frequency
/// omega^2 = lambda_max(M^-1 K) is at most max_i w_i (2 sum_{s at i} k_s + the stabilisers' row sum) (Gershgorin's rows
/// of the stretched springs' matrix; Hughes 1987 for the limit 2 / omega, which damping does not lower in this scheme).
/// Infinite without springs.
[[nodiscard]] double stable_step_s(const SpringSystem& springs, std::span<const double> inverse_mass,
                                   const StabilizerSystem& stabilizers = {});

}  // namespace selvage::sim
