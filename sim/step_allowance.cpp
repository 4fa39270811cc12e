#include "sim/step_allowance.h"

#include <algorithm>

#include "sim/contact_energy.h"
#include "sim/springs/spring_strain.h"

namespace selvage::sim {
namespace {

// The paper halves the step for a single collision, which in folds at speed leaves none much longer than the dynamics'.
// Impulses are good at few: up to one collision for 400 vertices that a few rounds resolve are borne, and an eighth of
// that still counts as a good step, or steps in which something always collides would stay as short as they are.
// docs/measurements/simulator-speed.md says what was measured. Small cloth (below 400 vertices) has the paper's rule.
constexpr std::int64_t kVerticesACollision = 400;
constexpr std::int64_t kImpulseRounds = 4;
constexpr std::int64_t kGoodShare = 8;

// Half the step bears twice as much, up to this: what an impulse or a contact moves is less by as much, and to halve
// the step again spares little. At 3 m/s contact overstrains 121 springs in 2.1 ms, and 36 in each half of them
// (sim/scenes/curtain.toml, 2.84 s). docs/measurements/simulator-speed.md says what it is worth.
constexpr std::int64_t kMaxBorne = 4;
std::int64_t borne(std::int32_t halvings) { return std::min(std::int64_t{1} << halvings, kMaxBorne); }

// What a collision step may put into the springs of a part of the cloth, of the energy that this has: otherwise the
// dynamics runs once more, and holds what was met. A step that is long beside the swing of stiff springs displaces
// vertices by more than these would let it. docs/measurements/stability.md says what it is worth, and what it costs.
constexpr double kEnergyBorne = 0.08;
// In steps longer than a 60th of a second, in which what cloth falls is no small share: of twelve sheets draped over a
// ball in steps of a 30th eight went on moving, by up to 6 mm a frame, ten seconds after they had come down. With this
// one does, by 2 mm, in 1.4 times the time.
constexpr double kEnergyBorneInLongSteps = 0.005;
constexpr double kLongStep_s = 1.01 / 60;
// In other runs, and under the implicit solver, which holds nearly all contacts in its first run: the dynamics runs
// again with what was met, and after the last run the step is halved. Very stiff cloth came to 16 and 43 times its
// energy in single steps, in which the collision step pushed out what was held (docs/measurements/stability.md). As
// much as there is, and no less, as what is squeezed would come to the shortest steps.
constexpr double kEnergyBorneAtLast = 1;

}  // namespace

StepAllowance::StepAllowance(const Scene& scene, const World& world, const SurfaceParts& parts)
    : scene_(scene),
      world_(world),
      parts_(parts),
      patience_{world.cloth_vertex_count / kVerticesACollision, kImpulseRounds} {}

Patience StepAllowance::patience_before_last(std::int32_t halvings) const {
  return {borne(halvings) * few(), kImpulseRounds};
}

std::int64_t StepAllowance::few() const { return patience_.collisions / kGoodShare; }

// Without this test a sheet of 16 x 16 vertices that falls on its edge has springs of a sixtieth of their length, and
// sim/scenes/table-legs.toml at full quality springs of 86 times their length.
bool StepAllowance::overstrains(const Positions& x_t0, const Positions& candidate, const Positions& x,
                                std::int32_t halvings) const {
  return springs_overstrained(world_.springs, scene_.strain.strain, {x_t0, candidate, x}) >
         borne(halvings) * patience_.collisions;
}

bool StepAllowance::energizes(const ResolvedStep& step, std::span<const double> inverse_mass, double dt_s,
                              bool is_new) const {
  const double fall_m_s = dt_s * scene_.gravity_m_s2.norm();
  const double borne_if_new = dt_s > kLongStep_s ? kEnergyBorneInLongSteps : kEnergyBorne;
  const double borne_share = is_new && scene_.solver == Solver::kExplicit ? borne_if_new : kEnergyBorneAtLast;
  return std::ranges::any_of(
      contact_energies(world_.springs, parts_, inverse_mass, step, fall_m_s),
      [&](const ContactEnergy& energy) { return energy.gain_j > borne_share * energy.before_j; });
}

}  // namespace selvage::sim
