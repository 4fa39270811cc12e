// Impulses between pairs of vertices that push one way only, and together leave the least kinetic energy; several pairs
// at once (SIMD, chosen at run time).
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "kernel/types.h"

namespace selvage::sim {

/// Vertices whose relative velocity along a direction has an upper bound.
struct BoundedPair {
  VertexId a = 0, b = 0;
  double inverse_mass_a = 0, inverse_mass_b = 0;  ///< 1/kg; not both 0
  Vec3 direction = Vec3::Zero();                  ///< unit; of the impulse on a, the opposite on b
  double excess_m_s = 0;   ///< direction . (v_b - v_a) less its bound >= 0; with `impulse_n_s` where that acts already
  double impulse_n_s = 0;  ///< >= 0
  double change_n_s = 0;   ///< what solve() adds to the impulse that acts
};

/// Pairs in whole blocks of lanes, zero beyond the last, scaled so that every diagonal element of their system is 1.
struct ProjectionColumns {
  std::vector<std::int32_t> a, b;  ///< where the impulses at their vertices stand
  std::vector<double> inverse_mass_a, inverse_mass_b;
  std::vector<double> x, y, z;                          ///< of the direction of the impulse
  std::vector<double> q, gradient, direction, product;  ///< impulses; where to; the system times `direction`
};

/// What is minimised, by l along the direction: `slope` l + `curvature` l^2 / 2. From `feasible` on an impulse pulls.
struct ProjectionCurve {
  double slope = 0, curvature = 0, feasible = 0;
};

/// Squares of what is left to improve where impulses act (no farther than they may shrink in a step), and where none
/// do; and gradient times product where they act.
struct ProjectionLeft {
  double acting = 0, missing = 0, turned = 0;
};

/// Minimises the kinetic energy plus the impulses times their bounds over all impulses p >= 0: where it is least no
/// pair is faster than its bound, and none that is slower has an impulse. To a ten-thousandth: each has a little
/// compliance, as bounds need not be such that all can be kept. By MPRGP, conjugate gradients while the same impulses
/// act and projected steps where that changes (Dostal and Schoeberl 2005), scaled by the pairs' own mobilities. What is
/// minimised falls in every iteration, and begins at no more than without impulses: stopped anywhere, they add no
/// kinetic energy, in real numbers and beside vertices at rest that cannot move. O(pairs) an iteration, on one thread;
/// same bits for any vector unit.
class ImpulseProjection {
 public:
  explicit ImpulseProjection(std::int32_t vertex_count);

  enum class Start : std::uint8_t {
    kGuess,   ///< impulses do not act yet; they are taken as far as that leaves less energy than none
    kActing,  ///< goes on from impulses that act; pairs may be new since the last call
  };
  /// Finds the impulses of the pairs in at most `iterations`: until what is left to improve is a fiftieth of what it
  /// was without any. Changes nothing where numbers are not finite.
  void solve(std::vector<BoundedPair>& pairs, Start start, std::int32_t iterations);
  /// What was to improve before the last kGuess, of which kActing leaves a fiftieth: to be given back where other pairs
  /// were solved for between the two.
  [[nodiscard]] double first_m_s() const { return first_m_s_; }
  void begin_from(double first_m_s) { first_m_s_ = first_m_s; }

 private:
  void set_rows(const std::vector<BoundedPair>& pairs, double fastest);
  std::int32_t row_vertex(VertexId vertex);
  /// Finds the product of the direction.
  ProjectionCurve look_along();
  void go_along(double length);
  void take_guess();
  void add_missing();
  void improve_acting();
  void project_gradient();

  ProjectionColumns columns_;
  std::vector<double> scale_;                ///< by pair
  std::vector<Eigen::Vector4d> directions_;  ///< by pair: once more, for vertices one by one; fourth zero
  std::vector<Eigen::Vector4d> impulse_at_;  ///< by vertex of a pair, in the order of first use
  std::vector<std::int32_t> row_vertex_;     ///< by vertex; -1 between calls
  std::vector<VertexId> vertices_;
  double inverse_step_ = 1;  ///< of projected gradients: no less than the largest eigenvalue
  double first_m_s_ = 0;     ///< what was to improve without any impulse, scaled
  ProjectionLeft left_;
  bool is_new_face_ = true;
};

}  // namespace selvage::sim
