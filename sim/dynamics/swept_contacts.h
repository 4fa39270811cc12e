// Held contacts under explicit dynamics: sweeps of impulses in every step of it (projected Gauss-Seidel), eight
// contacts at once.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "sim/base/lane_vectors.h"
#include "sim/contact/quick_proximity.h"
#include "sim/contact/repulsion_contact.h"
#include "sim/dynamics/contact_gains.h"
#include "sim/dynamics/contact_groups.h"
#include "sim/dynamics/contact_pack.h"
#include "sim/dynamics/held_contacts.h"
#include "sim/dynamics/straight_lanes.h"

namespace selvage::sim {

/// One step of the dynamics, of h seconds, that ends at `share` in (0, 1] of the collision step: x_t1 = x + h v.
struct MidstepMotion {
  double h, share;
  LaneVectors& x_t1;
  LaneVectors& v;
};

class SweptContacts {
 public:
  /// `held`, which must outlive it, has contacts (asserted). O(contacts), in parallel.
  explicit SweptContacts(HeldContacts& held);

  /// In this order, each where the contacts are now:
  ///   1. the loads, with their friction;
  ///   2. `limit`, the limits on strain, which else see cloth fall that is borne, and have it pull on what bears it
  ///      (docs/measurements/numerics.md);
  ///   3. sweeps of inelastic impulses, with friction in the last (paper, 7.2 and 7.3). Contacts of unlike masses, and
  ///      those beside them, take more sweeps than others, the first ones (contact_sweeps.h). In turn back and forth,
  ///      but vertices before edges always: in cloth at rest on a plane they leave nothing for the edges between them
  ///      to press, while edges alone lift one end to hold the other (a corner swung by 2 micrometres for ever);
  ///   4. where 1 and 3 have given cloth that hangs together more energy than it falls by in 100 steps, past what
  ///      bodies bring by their motion, all of it once more, without the loads of that cloth. `limit` may begin with
  ///      what it found before: limits pass on what loads pushed too far, and leave it where the sweeps take that back.
  ///      Loads grew by it, and a disc of 150 faces around one vertex, folded over a needle, flew off at 1,136 m/s
  ///      (docs/measurements/stability.md).
  ///
  /// A contact alone, but for one beyond what is straight in it, ends no nearer than its thickness, or than it was
  /// before the step, after any number of sweeps, and adds no energy: it takes back what its load or an earlier sweep,
  /// over-relaxed, pushed too far, and the friction that it began with. Where its lever is limited (interaction.h) it
  /// is pushed once, as far as that lets it. Of many something is left (tests/sim/energy_test.cpp asks their energy).
  /// They keep linear momentum.
  ///
  /// Where they are now: held where they were at the start of the collision step, cloth that a ball pulls along at 3.6
  /// m/s gained 8 % of kinetic energy in 25 ms at steps of 4 ms, and what slid off an edge was held in the air. A
  /// vertex that has left its face is held by the one on which it is: held by the border that it left, cloth without
  /// friction that slid at 2 m/s over a flat ground of small faces slowed to 1.5 m/s in a second.
  ///
  /// Call for the steps of a collision step in their order. O(contacts) a sweep, eight at once and in parallel where
  /// contacts share no vertex (contact_groups.h); one that slides on to a vertex of another of its eight acts alone
  /// from then on. Same bits for any number of threads and any vector unit.
  void hold(const MidstepMotion& step, const std::function<void()>& limit);

  /// To be called after the last hold(): tells the held contacts where they were last looked at, what they bear and
  /// what they did. O(contacts), in parallel.
  void finish();

 private:
  using Reach = ContactGroups::Reach;
  using Refused = ContactGroups::Refused;
  enum class Answer { kNo, kYes, kOutOfReach };

  /// What is asked of every pack in every step of the dynamics, side by side: most packs need not be read for it.
  struct PackState {
    LaneMask loaded = 0;            ///< whose load is above zero
    LaneMask withheld = 0;          ///< of cloth to which loads have added energy in this step
    LaneMask straight = 0;          ///< on bodies that go straight on there
    LaneMask beyond = 0;            ///< of these, whose points were not over what is straight when last looked at
    std::uint32_t straight_at = 0;  ///< of straight_
    bool has_acted = false;         ///< in this step: what pressed and rubbed may be other than zero
  };

  /// The packs of one kind of pair, from `first_pack` on in packs_.
  struct Kind {
    PairKind kind;
    std::vector<std::size_t> contacts;  ///< that are members of the groups
    ContactGroups groups;
    std::size_t first_pack = 0;
  };

  void group(Kind& kind);
  void place(const Kind& kind);
  [[nodiscard]] RepulsionContact& contact_at(std::size_t place) { return held_.contact(contact_at_[place]); }
  [[nodiscard]] const RepulsionContact& contact_at(std::size_t place) const {
    return held_.contacts()[contact_at_[place]];
  }
  void set_lane(std::size_t place);
  void set_straight();
  void set_sweeps();
  void begin_with_loads();
  void begin_with(const HeldContacts::Load& load, std::size_t place);

  void bear_packs(const ContactMotion& motion);
  void sweep(const ContactMotion& motion);
  void take_work_from_outside(const ContactMotion& motion);
  void withhold_loads(double borne_j_kg);
  void learn_all(double h);
  void forget_impulses();
  template <class Body>
  void each_pack(const Body& body);
  [[nodiscard]] PairKind kind_of(std::size_t pack) const { return pack < ee_.first_pack ? vf_.kind : ee_.kind; }
  void fetch(std::size_t pack, std::size_t idle_bytes);
  /// Those that have pressed in this step of the dynamics.
  [[nodiscard]] LaneMask pressing(std::size_t pack) const;
  [[nodiscard]] ContactMotion motion_of(const MidstepMotion& step) const;
  [[nodiscard]] VertexId cloth_of(std::size_t place) const;
  [[nodiscard]] Refused bear_pack(std::size_t pack, LaneMask lanes, const Reach& reach, const ContactMotion& motion);
  [[nodiscard]] Refused press_pack(std::size_t pack, LaneMask lanes, const Reach& reach, int left,
                                   const ContactMotion& motion);
  /// Looks where the contacts are now; leaves in `lanes` those that can act.
  [[nodiscard]] Refused look_again(std::size_t pack, const Reach& reach, const ContactMotion& motion, PackMotion& read,
                                   LaneMask& lanes);
  struct Slid {
    Refused refused;
    LaneMask on = 0;       ///< to other faces
    LaneMask cannot = 0;   ///< move there
    LaneMask beyond = 0;   ///< what is straight
    LaneMask through = 0;  ///< the surface: stay as they are
  };
  [[nodiscard]] Slid slide(std::size_t pack, LaneMask lanes, const Reach& reach, const ContactMotion& motion);
  [[nodiscard]] bool shares_vertex(std::size_t place, LaneMask with) const;
  [[nodiscard]] Answer slides_on(RepulsionContact& contact, QuickProximity& nearest, const Reach& reach,
                                 const ContactMotion& motion) const;
  [[nodiscard]] bool is_within(const Reach& reach, const std::array<VertexId, 3>& face) const;
  /// Of the contact's vertices at the start of the step.
  [[nodiscard]] PairVectors positions(const std::array<VertexId, 4>& vertices, const ContactMotion& motion) const;

  HeldContacts& held_;
  std::int32_t most_sweeps_;
  LaneVectors scripted_t0_, scripted_way_, scripted_bow_;  ///< of the vertices that are not cloth
  Kind vf_{PairKind::kVf, {}, {}}, ee_{PairKind::kEe, {}, {}};
  ContactGains gains_;
  std::vector<ContactPack> packs_;           ///< of vf, then ee; a place is a lane of one
  std::vector<PackState> states_;            ///< of each pack
  std::vector<PackStraight> straight_;       ///< of packs with such a lane
  std::vector<std::size_t> contact_at_;      ///< of each place
  LaneVectors v_free_, x_free_, v_limited_;  ///< before anything acted, and behind the limits
  bool backwards_ = false;
};

}  // namespace selvage::sim
