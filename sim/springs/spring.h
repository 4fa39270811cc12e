// Springs between pairs of vertices (paper, section 3).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "kernel/types.h"
#include "sim/springs/stabilizer.h"

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

/// Springs with the list of those that end at each vertex.
class SpringSystem {
 public:
  SpringSystem() = default;  ///< of no vertex
  /// REQUIRES ends in [0, vertex_count), a != b, and fewer than 2^31 springs.
  SpringSystem(std::vector<Spring> springs, std::int32_t vertex_count);

  [[nodiscard]] const std::vector<Spring>& springs() const { return springs_; }
  [[nodiscard]] std::int32_t vertex_count() const { return static_cast<std::int32_t>(begin_.size()) - 1; }

  /// One end of a spring, as its vertex sees it.
  struct End {
    VertexId other;
    std::uint32_t spring : 31;
    std::uint32_t is_b : 1;
  };
  /// The springs at vertex i, in the order of their numbers.
  [[nodiscard]] std::span<const End> ends_at(VertexId i) const {
    const auto row = static_cast<std::size_t>(i);
    return {ends_.data() + begin_[row], begin_[row + 1] - begin_[row]};
  }
  /// Calls visit(spring number, sign) for them; sign is +1 where i is a.
  template <class Visit>
  void for_each_at(VertexId i, Visit visit) const {
    for (const End& end : ends_at(i)) visit(std::uint32_t{end.spring}, end.is_b ? -1.0 : 1.0);
  }

 private:
  std::vector<Spring> springs_;
  std::vector<std::size_t> begin_;  ///< the ends at vertex i are ends_[begin_[i] .. begin_[i + 1])
  std::vector<End> ends_;
};

/// By how much a spring is longer than at rest, over its length at rest.
[[nodiscard]] inline double elongation(const Spring& spring, const PositionsRef& x) {
  return (x.row(spring.b) - x.row(spring.a)).norm() / spring.rest_length_m - 1;
}
[[nodiscard]] inline double elastic_j(const Spring& spring, const PositionsRef& x) {
  const double longer_m = (x.row(spring.b) - x.row(spring.a)).norm() - spring.rest_length_m;
  return spring.stiffness_n_m / 2 * longer_m * longer_m;
}

/// The largest step for which central differencing of these springs is stable: 2 / omega, where the squared frequency
/// omega^2 = lambda_max(M^-1 K) is at most max_i w_i (2 sum_{s at i} k_s + the stabilisers' row sum) (Gershgorin's rows
/// of the stretched springs' matrix; Hughes 1987 for the limit 2 / omega, which damping does not lower in this scheme,
/// found to velocity_residual()). Infinite without springs.
[[nodiscard]] double stable_step_s(const SpringSystem& springs, std::span<const double> inverse_mass,
                                   const StabilizerSystem& stabilizers = {});

}  // namespace selvage::sim
