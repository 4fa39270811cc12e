// Limits on strain and strain rate, as momentum-conserving changes of velocity (paper, section 4).
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "sim/springs/impulse_projection.h"
#include "sim/springs/length_check.h"

namespace selvage::sim {

struct StrainLimits {
  double strain = 0.1;  ///< of the rest length, at the end of the step; 0: no limit. Dimensionless; section 4: 10 %
  double strain_rate = 0.1;  ///< of the current length, per step; 0: no limit. Dimensionless; section 4: 10 %
  std::int32_t strain_iterations =
      20;  ///< at most, in either of two rounds; limit_strain() says why not section 4's two
  std::int32_t strain_rate_iterations = 4;  ///< section 4: "only a few iterations are needed"
};

/// A step that the limits change. REQUIRES x_t1 = x_t0 + dt_s v, which they keep so.
struct LimitedMotion {
  const LaneVectors& x_t0;
  double dt_s;
  LaneVectors& v;
  LaneVectors& x_t1;
};

/// Both limits look at structural and shear springs, change v by impulses along the springs at x_t0, and leave the rows
/// of vertices with inverse mass 0 alone. Impulses are equal and opposite, so linear momentum and angular momentum
/// about x_t0 are kept to rounding. Each impulse of the rates by itself, and those of the strains together, take energy
/// away. They return the number of impulses. Deterministic for any thread count.
class StrainLimiter {
 public:
  StrainLimiter(const SpringSystem& springs, const StrainLimits& limits);  ///< springs outlive it

  /// A spring that would end the step longer (shorter) than its limit is slowed until it ends there; one that is beyond
  /// its limit already is kept from getting worse, and its own force brings it back: pulling it back within the step
  /// would put energy in. All together, by the impulses that leave the least kinetic energy (impulse_projection.h), for
  /// the springs that were too long or too short, then once more with those that these make so; apart for what hangs
  /// together by springs, as what is found is of a sum: while another cloth was pulled in two, a sheet that hung was
  /// 0.41 longer in place of 0.23. Two rounds of Jacobi, as in section 4, pass a load on by two springs a step: a sheet
  /// that hung by two corners was stretched there to twice its length, and is by a fifth
  /// (docs/measurements/numerics.md). Begins with what springs bore in the step before. O(springs) to find them,
  /// O(those found) an iteration.
  std::int64_t limit_strain(std::span<const double> inverse_mass, const LimitedMotion& motion);
  /// Forgets what springs bore: before steps of another length, or from another state.
  void forget();

  /// Gauss-Seidel in the order of the springs: no spring changes its length by more than strain_rate within the step,
  /// but back to its length at rest. Springs that were held back there worked against their own forces, and explicit
  /// steps made energy of it where forces ask for far more than the limit: a sheet that fell on a ball came to 12 times
  /// its length at a limit of 0.001, to 1.2 times as it is (docs/measurements/numerics.md, *Limits on strain*). Stops
  /// early when a sweep finds nothing. Springs that no impulse can have pushed over their limit are passed over, so a
  /// sweep costs what it changes.
  std::int64_t limit_strain_rate(std::span<const double> inverse_mass, const LimitedMotion& motion);

 private:
  struct Limited {
    std::size_t spring;
    bool is_long;  ///< else short
  };
  struct Look {
    BoundedPair pair;
    Limited limited;
  };
  /// Nothing where the spring bears nothing and stays within its limits.
  [[nodiscard]] std::optional<Look> look_at(std::size_t spring, std::span<const double> inverse_mass,
                                            const LimitedMotion& motion) const;
  /// Of cloth that hangs together by springs.
  struct Set {
    std::vector<BoundedPair> pairs = {};
    std::vector<Limited> limited = {};  ///< by pair
    double first_m_s = 0;               ///< as in ImpulseProjection
  };
  /// Springs to limit, by what they bear and `is_suspect_`.
  void find_pairs(std::span<const double> inverse_mass, const LimitedMotion& motion);
  /// Finds the impulses of a set, and adds them. How many they are.
  std::int64_t limit(Set& set, ImpulseProjection::Start start, std::span<const double> inverse_mass,
                     const LimitedMotion& motion);
  void apply(const Spring& spring, const Eigen::RowVector3d& impulse, std::span<const double> inverse_mass,
             const LimitedMotion& motion) const;
  /// Whether v changed.
  bool relax_rate(const Spring& spring, std::span<const double> inverse_mass, const LimitedMotion& motion) const;
  void suspect_springs_at(VertexId vertex);

  const SpringSystem& springs_;
  StrainLimits limits_;
  LengthCheck check_;
  std::vector<std::uint8_t> is_suspect_;  ///< by spring: the others have nothing to correct
  ImpulseProjection projection_;
  std::vector<std::size_t> suspects_;
  std::vector<std::optional<Look>> looks_;  ///< by suspect
  std::vector<std::size_t> set_of_;         ///< by vertex: of sets_
  std::vector<Set> sets_;
  std::vector<std::size_t> bearing_;  ///< springs that bear
  std::vector<double> borne_n_s_;     ///< by spring, in a step: > 0 where it pulls its ends together, < 0 apart
};

}  // namespace selvage::sim
