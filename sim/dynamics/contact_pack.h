// Contacts in lanes: eight that share no vertex of cloth act at once (swept_contacts.h).
#pragma once

#include <array>
#include <cstdint>

#include "sim/base/lane_vectors.h"
#include "sim/dynamics/contact_groups.h"

namespace selvage::sim {

/// One value a lane.
template <class T>
using LaneColumn = std::array<T, kLanes>;
using LaneColumn3 = std::array<LaneColumn<double>, 3>;
[[nodiscard]] inline Vec3 vector_in(const LaneColumn3& columns, std::size_t lane) {
  return {columns[0][lane], columns[1][lane], columns[2][lane]};
}

/// What contacts are and what they have done, in columns. An index i >= 0 is vertex i, of cloth; ~k, which is negative,
/// is row k of the scripted vertices. Lanes without a contact are zero.
struct alignas(64) ContactPack {
  // What newly_pressed() reads.
  std::array<LaneColumn<std::int32_t>, 4> vertices{};
  std::array<LaneColumn<double>, 4> weights{};  ///< as in Interaction; so are mobilities
  LaneColumn3 normal{};                         ///< unit
  LaneColumn<double> thickness_m{};
  LaneColumn<double> load_m_s2{};  ///< as in ContactLoad, and its friction
  LaneColumn<double> pressed{};    ///< in this step of the dynamics, as in FrictionLoad; so is what rubbed
  // What those that act read as well.
  std::array<LaneColumn<double>, 4> mobility{};
  LaneColumn<double> friction_static{}, friction_kinetic{};
  LaneColumn3 friction_m_s2{};
  LaneColumn3 rubbed{};
  LaneColumn<std::int32_t> sweeps{};  ///< where not all take as many
  LaneMask ever_repelled = 0, ever_rubbed = 0;
};

/// The cloth in a step of the dynamics of h seconds, x_t1 = x + h v, and what is not cloth: at
/// x + s way - s (1 - s) bow, from s = share at the start to share + step_share.
struct ContactMotion {
  LaneVectors& x_t1;
  LaneVectors& v;
  const LaneVectors& scripted_x;
  const LaneVectors& scripted_way;
  double h, share, step_share;
  double creep_m = 0;                         ///< as in FrictionCoefficients
  const LaneVectors* scripted_bow = nullptr;  ///< null: none
};

/// The vertices of a pack, at the start of the step and how they move in it.
struct alignas(64) PackMotion {
  std::array<LaneColumn3, 4> x, displacement;  // read_motion() sets all: zeros before that would be 1.5 kB for nothing
  LaneMask lanes = 0;                          ///< that were read; zero in the others
};

/// Nearest points of the pairs of a pack at the start of the step, as in QuickProximity.
struct PackNearest {
  LaneColumn<double> distance;
  LaneColumn3 direction;
  std::array<LaneColumn<double>, 4> weights;
  LaneMask on_border = 0;  ///< a corner has no weight: the surface may go on beyond
};

/// What its contact begins the next step with.
void set_load(double along_m_s2, const Vec3& friction_m_s2, std::size_t lane, ContactPack& pack);

/// Those whose column is above zero; that take as many sweeps.
[[nodiscard]] LaneMask above_zero(const LaneColumn<double>& column);
[[nodiscard]] LaneMask that_take(std::int32_t sweeps, const ContactPack& pack);

// For all lanes, or for those given; same bits for any vector unit. What an impulse is and why is said in
// swept_contacts.h, what friction is in friction.h.

void read_motion(const ContactPack& pack, LaneMask lanes, const ContactMotion& motion, PackMotion& result);

/// Those that approach too far, and neither bear a load nor have pressed in this step.
[[nodiscard]] LaneMask newly_pressed(const ContactPack& pack, const PackMotion& motion, LaneMask lanes);

void find_nearest(PairKind kind, const PackMotion& motion, PackNearest& result);

/// The contacts at their nearest points, but for those that are nearer than the thickness on the other side, which stay
/// as they are. Leaves out those whose points are all on vertices that cannot move.
[[nodiscard]] LaneMask take_nearest(const PackNearest& nearest, LaneMask lanes, ContactPack& pack);

/// From where they are, whatever the side was from which they were seen.
void see_anew(const PackNearest& nearest, LaneMask lanes, ContactPack& pack);

/// Their loads with their friction.
void bear_loads(const PackMotion& read, LaneMask lanes, ContactPack& pack, const ContactMotion& motion);

/// One sweep; `relaxation` is the factor on what is missing. The last one rubs.
void press(const PackMotion& read, LaneMask lanes, double relaxation, bool is_last, ContactPack& pack,
           const ContactMotion& motion);

/// The work that vertices which no impulse moves, of bodies and at pins, do on the others of their contact in this
/// step, by what has pressed and rubbed: joules times the square of the step and times Interaction::inverse_mass_scale.
/// Normal and weights are those by which it pressed, as a contact is not looked at again while it presses.
void find_work_from_outside(const ContactPack& pack, const PackMotion& motion, LaneColumn<double>& result);

/// From what they did, what they begin the next step with: `share` of what was missing or too much.
void learn_loads(PairKind kind, double share, double h, ContactPack& pack);

}  // namespace selvage::sim
