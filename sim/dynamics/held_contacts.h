// Contacts that the dynamics holds within a collision step, and what they bear. A collision step holds many steps of
// the dynamics: a dynamics that does not know of contact carries cloth into what it lies on and springs on with it, all
// of which the repulsions then take back at once. What rests, rests differently for every length of the step then, and
// springs beside a contact are crushed.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "sim/base/vertex_faces.h"
#include "sim/contact/contact_table.h"
#include "sim/contact/repulsion_contact.h"
#include "sim/contact/surface_parts.h"
#include "sim/dynamics/contact_load.h"

namespace selvage::sim {

/// What the contacts are on; all must outlive them. The first `cloth_count` vertices move as the dynamics says, the
/// others as V_t0 + s (V_t1 - V_t0) - s (1 - s) bow, s from 0 to 1 in the collision step: on straight lines without.
/// Where a body speeds up or turns, cloth that sticks to it has its speed at the end of the step then. On straight
/// lines it met another one in every step, and slipped by (a dt)^2 / (2 mu g) until friction had caught up: 15 mm/s on
/// a table that turned at 2 rad/s, half a metre from its axis, in steps of 1/30 s under a friction of 0.5.
struct HeldSurface {
  const Mesh& mesh;
  const SurfaceParts& parts;
  const VertexFaces& faces;
  const ContactTable& properties;
  std::span<const double> inverse_mass;
  Eigen::Index cloth_count;
  Vec3 gravity_m_s2;
  const Positions* bow_m = nullptr;  ///< of those that are not cloth, by 3; null: none

  [[nodiscard]] bool is_cloth(VertexId vertex) const { return vertex < cloth_count; }
};

/// They do not act by themselves: explicit dynamics sweeps over them (swept_contacts.h), an implicit one solves for
/// what they bear (stage_contacts.h).
class HeldContacts {
 public:
  /// Of a collision step of dt_s from V_t0, to V_t1 where it is scripted; `sweeps` for those that sweep. `loads` are
  /// those at V_t0. The positions must outlive it. REQUIRES contacts of kVf or kEe of which cloth can move, and
  /// sweeps >= 1.
  HeldContacts(std::vector<RepulsionContact> contacts, const ContactLoads& loads, const HeldSurface& surface,
               const Positions& V_t0, const Positions& V_t1, double dt_s, std::int32_t sweeps);

  [[nodiscard]] const HeldSurface& surface() const { return surface_; }
  [[nodiscard]] const Positions& V_t0() const { return V_t0_; }
  [[nodiscard]] const Positions& V_t1() const { return V_t1_; }
  [[nodiscard]] double dt_s() const { return dt_s_; }
  [[nodiscard]] std::int32_t sweeps() const { return sweeps_; }
  /// Where a vertex that is not cloth is at `share` in [0, 1] of the collision step.
  [[nodiscard]] Vec3 scripted_at(VertexId vertex, double share) const {
    Vec3 at = V_t0_.row(vertex) + share * (V_t1_.row(vertex) - V_t0_.row(vertex));
    if (surface_.bow_m != nullptr) at -= share * (1 - share) * surface_.bow_m->row(vertex - surface_.cloth_count);
    return at;
  }

  [[nodiscard]] std::span<const RepulsionContact> contacts() const { return contacts_; }
  /// For those that act: they leave where it repels in vertices, weights, normal and is_beyond.
  [[nodiscard]] RepulsionContact& contact(std::size_t i) { return contacts_[i]; }

  struct Load {
    double along_m_s2 = 0;  ///< as in ContactLoad
    Vec3 friction_m_s2 = Vec3::Zero();
  };
  /// What a contact bears: first what it begins with.
  [[nodiscard]] const Load& load(std::size_t i) const { return borne_[i].load; }
  /// What it bears from now on, and what it has done besides. Different contacts may be told at once.
  void set_load(std::size_t i, const Load& load, bool has_repelled, bool has_rubbed);
  /// The order in which all of them act, where it is not that in which they were given: of those of one pair the first
  /// one's load is kept.
  void act_in(std::vector<std::size_t> order) { order_ = std::move(order); }

  /// Measured at V_t0, in the order in which they were given: the collision step repels them where they are at its end.
  [[nodiscard]] std::vector<RepulsionContact> take_contacts() &&;
  /// Those that repelled, and rubbed, in any step; in one in which all acted again, in either try.
  [[nodiscard]] RepulsionCount count() const;
  /// The pairs of those that repelled.
  [[nodiscard]] Candidates repelled_pairs() const;
  [[nodiscard]] ContactLoads loads() const;

 private:
  struct Borne {
    Load load;
    bool has_repelled = false, has_rubbed = false;
  };

  HeldSurface surface_;
  const Positions& V_t0_;
  const Positions& V_t1_;
  double dt_s_;
  std::int32_t sweeps_;
  std::vector<RepulsionContact> contacts_;
  std::vector<Borne> borne_;        ///< by contact
  std::vector<std::size_t> order_;  ///< in which they act
};

}  // namespace selvage::sim
