// Repulsions: pairs nearer than the cloth's thickness stop approaching, and a spring pushes them apart (paper, 7.2);
// pairs that are near come no nearer than the thickness.
#pragma once

#include <vector>

#include "sim/contact/collision_options.h"
#include "sim/contact/repulsion_contact.h"
#include "sim/response/friction.h"
#include "sim/response/step_motion.h"

namespace selvage::sim {

/// Changes of the relative displacement along the normal, >= 0, metres.
struct Repulsion {
  double inelastic = 0;  ///< takes away all approach beyond room_to_approach(); never adds energy
  double spring = 0;     ///< bounded: the pair separates by at most overlap_fraction of its overlap in the step
  [[nodiscard]] double total() const { return inelastic + spring; }
};

/// For two points that overlap by `overlap` (thickness less distance, m) and whose relative displacement over the step
/// has the normal component `displacement` (negative: approaching). `inverse_mass_kg` is the pair's K in 1/kg: an
/// impulse j changes the relative velocity by K j. Differs from the paper's formula in the spring's limit, which there
/// comes out twice as large for equal masses (impulse m dv for two particles of mass m changes their relative velocity
/// by 2 dv); its text asks for this one. And the spring's force k d is one at the two points: the paper's formula gives
/// the relative velocity 2 k d dt / m whatever the weights, which in the middle of a face is half as much force again.
[[nodiscard]] Repulsion repulsion(double overlap, double displacement, double inverse_mass_kg,
                                  const CollisionOptions& options, double dt_s);

/// Sweeps over the contacts of a step. Contacts act one after the other (paper, 7.2: "either sequentially or all at
/// once"), so each sees what the others before it did, and none has to be damped by its number of neighbours. Measured
/// on sim/scenes/demo.toml, pairs that collide although repulsions acted on them, in 85 frames: 1750 after 1 sweep,
/// 1060 after 3, 58 after 10, 43 after 30; after 10 rounds all at once, each contact with its share of 1 / number of
/// contacts at a vertex, 9400.
inline constexpr int kRepulsionSweeps = 10;
/// After the first sweep an approach or a slip below this share of the distance waits for the next step.
inline constexpr double kSettledApproach = 1e-6;

struct RepulsionChange {
  bool repels = false, rubs = false;
  PairVectors change = zero_vectors();  ///< of the four displacements
};

/// Repulsion and friction (7.2, 7.3) of one contact for the displacements as they are. The spring acts in sweep 0 only.
/// Friction acts in every sweep, in the cone of what the contact has pressed in all of them: with a cone for each sweep
/// a slip that a neighbour brought back was nobody's, and resting cloth crept (case cliff-edge, 18 x 18 vertices: 3.6
/// mm in the sixth second, now 0.5).
[[nodiscard]] RepulsionChange repel_contact(const RepulsionContact& contact, const Positions& displacement,
                                            const CollisionOptions& options, double dt_s, int sweep,
                                            FrictionLoad& load);

/// The contacts of a step; counts those that repelled, and rubbed, in their first sweep.
class Contacts {
 public:
  void clear();
  void add(const RepulsionContact& contact) { contacts_.push_back(contact); }
  [[nodiscard]] std::size_t size() const { return contacts_.size(); }
  /// Sweeps over the contacts in their order, then back, and so on, so that neither end of the cloth is favoured, until
  /// no contact has anything to change, at most `sweeps` times. No sweep adds energy but for the spring's, as no
  /// contact does. Serial: same bits for any thread count. May be called again after contacts have been added.
  void repel(const CollisionOptions& options, double dt_s, int sweeps, StepMotion& motion);

  [[nodiscard]] const RepulsionCount& count() const { return count_; }
  /// Those that have pressed, but for the first `left_out` that were added.
  [[nodiscard]] std::vector<RepulsionContact> pressed(std::size_t left_out) const;

 private:
  std::vector<RepulsionContact> contacts_;
  std::vector<FrictionLoad> loads_;  ///< of each contact that has been swept
  RepulsionCount count_;
};

}  // namespace selvage::sim
