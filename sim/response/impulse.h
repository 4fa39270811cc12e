// Impulses: what one pair asks for when it collides (paper, 7.4), and how many pairs are served at once.
//
// All impulses of a round are applied in parallel. A pair gets the share min(cap, 1 / n) of what it asks for, n the
// largest number of pairs that change one of its vertices. So a vertex ends at a convex combination of where the single
// pairs would put it, and by convexity of |v|^2
//     E(all) - E(before) <= sum over pairs of share * (E(that pair alone) - E(before)):
// if no pair alone adds energy, all together do not. Equal and opposite impulses stay so, whatever the share.
#pragma once

#include <span>
#include <vector>

#include "sim/contact/interaction.h"
#include "sim/response/step_motion.h"

namespace selvage::sim {

/// What one pair asks for: changes of its vertices' displacements, as if it were alone.
struct PairChange {
  std::array<VertexId, 4> vertices{};
  PairVectors change = zero_vectors();
};

/// Applies all changes at once, each with its share. Serial, in the given order: same bits for any thread count.
class ParallelUpdate {
 public:
  explicit ParallelUpdate(VertexId vertex_count);
  /// `share_cap` in (0, 1].
  void apply(std::span<const PairChange> changes, double share_cap, StepMotion& motion);

 private:
  std::vector<std::int32_t> interaction_count_;  ///< #V, 0 between calls
  std::vector<Vec3> sum_;                        ///< #V, 0 between calls
  std::vector<VertexId> touched_;                ///< empty between calls
};

/// Separation that a colliding pair is pushed to at the end of the step, in tolerances. With n pairs at a vertex one
/// round gives 1 / n of the push, and what matters is when `tolerance` is passed: at 2 after ln 2 / ln(n / (n-1))
/// rounds, which is 7 for n = 10, within the default max_impulse_rounds.
inline constexpr double kPushTolerances = 2;

/// The relative displacement that the pair must gain along a direction in which it is `gap_t0` apart at the start and
/// approaches by -`displacement`: all of the approach (completely inelastic), and the push that is missing at the end.
/// The push adds energy, at most that of the speed kPushTolerances * tolerance / dt. It stands where the paper has the
/// spring of 7.2, for pairs that are near at the end and move apart already: that need not reach the tolerance, and
/// here pairs that approach are pushed, too.
[[nodiscard]] double collision_change(double gap_t0, double displacement, double tolerance);

/// The impulse of one collision (paper, 7.4). A closed pair is stopped along the line of its two points at t = 0: on
/// straight paths that meet this is the line of their relative motion, and the only one along which the average
/// velocities of the step keep their angular momentum. Beside a scripted vertex it acts along the contact normal.
[[nodiscard]] PairChange collision_impulse(const Collision& collision, const Interaction& interaction,
                                           const StepMotion& motion, double tolerance);

}  // namespace selvage::sim
