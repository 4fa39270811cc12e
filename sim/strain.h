// Limits on strain and strain rate, as momentum-conserving changes of velocity (paper, section 4).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sim/spring.h"

namespace selvage::sim {

struct StrainLimits {
  double strain = 0.1;  ///< of the rest length, at the end of the step; 0: no limit. Dimensionless; section 4: 10 %
  double strain_rate = 0.1;            ///< of the current length, per step; 0: no limit. Dimensionless; section 4: 10 %
  std::int32_t strain_iterations = 2;  ///< section 4: "generally only one or two iterations"
  std::int32_t strain_rate_iterations = 4;  ///< section 4: "only a few iterations are needed"
};

/// Both limits look at structural and shear springs, change v by impulses along the springs at x, and leave the rows of
/// vertices with inverse mass 0 alone. Impulses are equal and opposite, so linear momentum and angular momentum about x
/// are kept to rounding. Each impulse by itself takes energy away. They return the number of impulses. `stretch` is
/// that of the springs at x. Deterministic for any thread count.
class StrainLimiter {
 public:
  StrainLimiter(const SpringSystem& springs, const StrainLimits& limits);  ///< springs outlive it

  /// Jacobi: all springs are judged by the same velocities. A spring that would end the step of dt_s longer (shorter)
  /// than its limit is slowed until it ends there; one that is beyond its limit already is kept from getting worse, and
  /// its own force brings it back: pulling it back within the step would put energy in. The impulses at a vertex with n
  /// active springs are divided by n: the sum of n rank-one corrections n_s n_s^T has eigenvalues up to n.
  std::int64_t limit_strain(std::span<const double> inverse_mass, const Positions& x, const SpringStretch& stretch,
                            double dt_s, Positions& v);

  /// Gauss-Seidel in the order of the springs: no spring changes its length by more than strain_rate within dt_s. Stops
  /// early when a sweep finds nothing. Springs that no impulse can have pushed over their limit are passed over, so a
  /// sweep costs what it changes.
  std::int64_t limit_strain_rate(std::span<const double> inverse_mass, const Positions& x, const SpringStretch& stretch,
                                 double dt_s, Positions& v);

 private:
  struct Limited {
    VertexId a, b;
    std::uint32_t spring;
    double shortest_squared, longest_squared;  ///< of the strain limit
  };
  /// Flags the limited springs whose squared length at the end of the step is outside the bounds: the others have
  /// nothing to correct.
  template <class Bounds>
  void find_suspects(const Positions& x, double dt_s, const Positions& v, Bounds bounds);
  /// Whether v changed.
  bool relax_rate(std::size_t s, std::span<const double> inverse_mass, const Positions& x, const SpringStretch& stretch,
                  double dt_s, Positions& v);
  void suspect_springs_at(VertexId vertex);

  const SpringSystem& springs_;
  StrainLimits limits_;
  std::vector<Limited> limited_;            ///< the structural and shear springs, in order
  Positions end_;                           ///< where the vertices would be at the end of the step
  std::vector<std::uint8_t> is_suspect_;    ///< by spring
  std::vector<std::size_t> active_;         ///< springs
  std::vector<double> change_;              ///< of them: of the rate of elongation
  std::vector<std::int32_t> active_count_;  ///< by vertex: active springs; 0 between calls
};

}  // namespace selvage::sim
