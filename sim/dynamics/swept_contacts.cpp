#include "sim/dynamics/swept_contacts.h"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <iterator>
#include <utility>

#include "kernel/assert.h"
#include "sim/base/parallel.h"
#include "sim/dynamics/contact_sweeps.h"

namespace selvage::sim {
namespace {

/// Share of what a contact had to add that it remembers, of its friction as well. A column of twelve that is put down
/// in steps of 0.4 ms keeps every distance to a hundredth and comes to rest
/// (tests/sim/dynamics/swept_contacts_test.cpp). Measured: with nothing it sinks, and with all of it velocities, which
/// last by themselves, are learnt as forces, and it swings.
constexpr double kLearning = 0.5;

/// Factor on what is missing, in all sweeps but the last (successive over-relaxation); what was too much is taken back
/// as it is. Measured: 25 sheets that are laid over a ball keep 2.5 to 3 mm of 3 under four sweeps with it, 1.3 to 3
/// without, 0.8 to 3 under one (docs/measurements/simulator-speed.md). Not in those that unlike masses take more, under
/// which it has heavy cloth bounce on light cloth: a veil under cloth 100 times as heavy went on at 79 mm/s with it, at
/// 12 without.
constexpr double kOverRelaxation = 1.7;

/// Slower than what falls for so many steps of the dynamics, what slips counts as sticking still, with the static cone.
/// In a step gravity and neighbours move a contact by as much, edges of bodies more, as they remember no load; and
/// where kinetic friction is below the slope, what begins to slide by that would never stop. Measured on planes of 8 to
/// 40 faces a side, slope 0.47 (docs/measurements/stability.md): 2 hold what has a fifth of static friction to spare,
/// so do 4; 6 and 8 hold a thirtieth, but what should slide begins to a tenth of a second late.
constexpr double kCreepSteps = 4;

/// Contact may add the energy of a fall of so many steps of the dynamics in one: columns of 12, 50 and 100 vertices
/// that settle on their loads add that of a fall of 4, 11 and 27 steps (tests/sim/dynamics/swept_contacts_test.cpp),
/// stacks of 60 and 150 sheets that of 57 and 95. Refused that, columns swing for ever, and the stack of 150 sinks to a
/// third of its height. In the discs of docs/measurements/stability.md it was 0.1 to 87,000 J/kg, where this is 0.005
/// to 0.09.
constexpr double kSettlingSteps = 100;

/// In parallel.
void copy(const LaneVectors& from, LaneVectors& to) {
  to.resize(from.rows());
  parallel_blocks(from.rows(), [&](Eigen::Index begin, Eigen::Index end) {
    for (int k = 0; k < 3; ++k) std::copy(from.axis(k) + begin, from.axis(k) + end, to.axis(k) + begin);
  });
}

}  // namespace

SweptContacts::SweptContacts(HeldContacts& held)
    : held_(held),
      most_sweeps_(held.sweeps()),
      gains_(held.surface().parts, held.contacts(), held.surface().inverse_mass, held.surface().cloth_count) {
  SELVAGE_ASSERT(!held.contacts().empty());
  const HeldSurface& surface = held.surface();
  const Eigen::Index scripted = held.V_t0().rows() - surface.cloth_count;
  scripted_t0_.copy(held.V_t0().bottomRows(scripted));
  scripted_way_.copy(held.V_t1().bottomRows(scripted) - held.V_t0().bottomRows(scripted));
  if (surface.bow_m != nullptr) scripted_bow_.copy(*surface.bow_m);
  group(vf_);
  group(ee_);
  ee_.first_pack = vf_.groups.order().size() / kLanes;
  packs_.resize(ee_.first_pack + ee_.groups.order().size() / kLanes);
  states_.resize(packs_.size());
  contact_at_.resize(packs_.size() * kLanes, ContactGroups::kNobody);
  place(vf_);
  place(ee_);
  const auto is_empty = [](std::size_t contact) { return contact == ContactGroups::kNobody; };
  SELVAGE_ASSERT(std::ranges::count_if(contact_at_, is_empty) + std::ssize(held.contacts()) == std::ssize(contact_at_));
  set_straight();
  set_sweeps();
  begin_with_loads();
}

/// In the order in which they act. Groups are columns along gravity, in which a sweep passes a weight on through all
/// layers: as cubes the fifty of sim/scenes/stack.toml as a draft came as near as 0.6 mm of 3, as columns 1.7
/// (docs/measurements/simulator-speed.md).
void SweptContacts::group(Kind& kind) {
  const std::span<const RepulsionContact> contacts = held_.contacts();
  const HeldSurface& surface = held_.surface();
  const Vec3 down = surface.gravity_m_s2.stableNormalized();
  std::vector<ContactGroups::Member> members;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    if (contacts[i].kind != kind.kind) continue;
    kind.contacts.push_back(i);
    std::array<VertexId, 4> vertices = contacts[i].interaction.vertices;
    const Vec3 at = held_.V_t0().row(vertices.front());
    std::ranges::replace_if(
        vertices, [&](VertexId v) { return !surface.is_cloth(v); }, -1);
    SELVAGE_ASSERT(std::ranges::any_of(vertices, [](VertexId v) { return v >= 0; }));
    members.push_back({vertices, at - down.dot(at) * down});
  }
  const bool is_vf = kind.kind == PairKind::kVf;
  kind.groups = ContactGroups(members, surface.cloth_count,
                              is_vf ? ContactGroups::Order::kAsGiven : ContactGroups::Order::kNearly);
}

void SweptContacts::place(const Kind& kind) {
  const std::vector<std::size_t>& order = kind.groups.order();
  parallel_each(std::ssize(order), [&](Eigen::Index at) {
    const std::size_t member = order[static_cast<std::size_t>(at)];
    if (member == ContactGroups::kNobody) return;
    const std::size_t place = kind.first_pack * kLanes + static_cast<std::size_t>(at);
    contact_at_[place] = kind.contacts[member];
    set_lane(place);
  });
}

void SweptContacts::set_lane(std::size_t place) {
  const RepulsionContact& contact = contact_at(place);
  const HeldSurface& surface = held_.surface();
  ContactPack& pack = packs_[place / kLanes];
  const std::size_t lane = place % kLanes;
  for (std::size_t i = 0; i < 4; ++i) {
    const VertexId vertex = contact.interaction.vertices[i];
    pack.vertices[i][lane] = surface.is_cloth(vertex) ? vertex : ~(vertex - static_cast<VertexId>(surface.cloth_count));
    pack.weights[i][lane] = contact.interaction.weights[i];
    pack.mobility[i][lane] = contact.interaction.mobility[i];
  }
  for (int k = 0; k < 3; ++k) pack.normal[static_cast<std::size_t>(k)][lane] = contact.normal[k];
  pack.thickness_m[lane] = contact.properties.thickness_m;
  pack.friction_static[lane] = contact.properties.friction_static;
  pack.friction_kinetic[lane] = contact.properties.friction_kinetic;
}

/// The same all through the step: a vertex of a body stays that, and edges do not slide on.
void SweptContacts::set_straight() {
  for (std::size_t place = 0; place < contact_at_.size(); ++place) {
    if (contact_at_[place] == ContactGroups::kNobody || !contact_at(place).straight.is_anywhere()) continue;
    PackState& state = states_[place / kLanes];
    if (state.straight == 0) {
      state.straight_at = static_cast<std::uint32_t>(straight_.size());
      straight_.emplace_back();
    }
    state.straight |= only_lane(place % kLanes);
    if (contact_at(place).is_beyond) state.beyond |= only_lane(place % kLanes);
  }
  each_pack([&](std::size_t id) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      if (!has_lane(states_[id].straight, lane)) continue;
      const RepulsionContact& contact = contact_at(id * kLanes + lane);
      sim::set_straight(contact.kind, contact.straight, held_.V_t0(), held_.V_t1(), lane,
                        straight_[states_[id].straight_at]);
    }
  });
}

void SweptContacts::set_sweeps() {
  const std::vector<std::int32_t> sweeps = contact_sweeps(held_.contacts(), held_.surface().faces, held_.sweeps());
  if (sweeps.empty()) return;
  for (std::size_t place = 0; place < contact_at_.size(); ++place) {
    if (contact_at_[place] == ContactGroups::kNobody) continue;
    packs_[place / kLanes].sweeps[place % kLanes] = sweeps[contact_at_[place]];
  }
  most_sweeps_ = std::ranges::max(sweeps);
}

void SweptContacts::begin_with_loads() {
  each_pack([&](std::size_t id) {
    for (std::size_t place = id * kLanes; place < (id + 1) * kLanes; ++place) {
      if (contact_at_[place] != ContactGroups::kNobody) begin_with(held_.load(contact_at_[place]), place);
    }
  });
}

void SweptContacts::begin_with(const HeldContacts::Load& load, std::size_t place) {
  ContactPack& pack = packs_[place / kLanes];
  set_load(load.along_m_s2, load.friction_m_s2, place % kLanes, pack);
  std::atomic_ref(states_[place / kLanes].loaded).store(above_zero(pack.load_m_s2), std::memory_order_relaxed);
}

/// In parallel, in blocks of as many contacts as other loops have items.
template <class Body>
void SweptContacts::each_pack(const Body& body) {
  parallel_blocks(std::ssize(packs_) * kLanes, [&](Eigen::Index begin, Eigen::Index end) {
    for (Eigen::Index id = begin / kLanes; id < end / kLanes; ++id) body(static_cast<std::size_t>(id));
  });
}

/// Packs are read one after the other, and all of them take more than a core's cache: the next one, or, where it bears
/// no load, its first `idle_bytes`. It may be another thread's, which may end a load just now; then too much is
/// fetched.
void SweptContacts::fetch(std::size_t pack, std::size_t idle_bytes) {
  if (pack >= packs_.size()) return;
  const bool is_loaded = std::atomic_ref(states_[pack].loaded).load(std::memory_order_relaxed) != 0;
  const std::size_t size = is_loaded ? sizeof(ContactPack) : idle_bytes;
  const auto* const bytes = reinterpret_cast<const char*>(&packs_[pack]);
  for (std::size_t k = 0; k < size; k += 64) __builtin_prefetch(bytes + k);
}

LaneMask SweptContacts::pressing(std::size_t pack) const {
  return states_[pack].has_acted ? above_zero(packs_[pack].pressed) : LaneMask{0};
}

ContactMotion SweptContacts::motion_of(const MidstepMotion& step) const {
  const HeldSurface& surface = held_.surface();
  const double step_share = step.h / held_.dt_s();
  const double creep_m = kCreepSteps * step.h * step.h * surface.gravity_m_s2.norm();
  const LaneVectors* const bow = surface.bow_m != nullptr ? &scripted_bow_ : nullptr;
  return {step.x_t1, step.v, scripted_t0_, scripted_way_, step.h, step.share - step_share, step_share, creep_m, bow};
}

void SweptContacts::hold(const MidstepMotion& step, const std::function<void()>& limit) {
  const double fall_m_s = kSettlingSteps * step.h * held_.surface().gravity_m_s2.norm();
  const double borne_j_kg = fall_m_s * fall_m_s / 2;
  const bool backwards = backwards_;
  const ContactMotion motion = motion_of(step);
  copy(step.v, v_free_);
  copy(step.x_t1, x_free_);
  gains_.clear();
  bear_packs(motion);
  gains_.add_motion(v_free_, step.v);
  const bool may_be_too_much = gains_.exceed(borne_j_kg);
  limit();
  if (may_be_too_much) v_limited_ = step.v;
  sweep(motion);
  if (may_be_too_much) {
    gains_.add_motion(v_limited_, step.v);
    take_work_from_outside(motion);
    if (gains_.exceed(borne_j_kg)) {
      step.v = v_free_;
      step.x_t1 = x_free_;
      forget_impulses();
      withhold_loads(borne_j_kg);
      bear_packs(motion);
      limit();
      backwards_ = backwards;
      sweep(motion);
    }
  }
  learn_all(step.h);
  forget_impulses();
}

void SweptContacts::learn_all(double h) {
  each_pack([&](std::size_t id) {
    PackState& state = states_[id];
    state.withheld = 0;
    if (!state.has_acted && state.loaded == 0) return;
    learn_loads(kind_of(id), kLearning, h, packs_[id]);
    state.loaded = above_zero(packs_[id].load_m_s2);
  });
}

void SweptContacts::forget_impulses() {
  each_pack([&](std::size_t id) {
    if (!std::exchange(states_[id].has_acted, false)) return;
    packs_[id].pressed = {};
    packs_[id].rubbed = {};
  });
}

void SweptContacts::bear_packs(const ContactMotion& motion) {
  for (Kind* kind : {&vf_, &ee_}) {
    kind->groups.each(false, [&](std::size_t pack, LaneMask lanes, const Reach& reach) {
      return bear_pack(kind->first_pack + pack, lanes, reach, motion);
    });
  }
}

void SweptContacts::sweep(const ContactMotion& motion) {
  for (int left = most_sweeps_; left > 0; --left) {
    for (Kind* kind : {&vf_, &ee_}) {
      kind->groups.each(backwards_, [&](std::size_t pack, LaneMask lanes, const Reach& reach) {
        const std::size_t id = kind->first_pack + pack;
        if (left > held_.sweeps()) lanes &= that_take(left, packs_[id]);
        return lanes == 0 ? Refused{} : press_pack(id, lanes, reach, left, motion);
      });
    }
    backwards_ = !backwards_;
  }
}

/// What bodies and pins do by their motion to cloth that presses on them.
void SweptContacts::take_work_from_outside(const ContactMotion& motion) {
  for (std::size_t id = 0; id < packs_.size(); ++id) {
    const LaneMask lanes = pressing(id);
    if (lanes == 0) continue;
    PackMotion read;
    read_motion(packs_[id], lanes, motion, read);
    LaneColumn<double> work;
    find_work_from_outside(packs_[id], read, work);
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      if (!has_lane(lanes, lane)) continue;
      const std::size_t place = id * kLanes + lane;
      const double scale = contact_at(place).interaction.inverse_mass_scale * motion.h * motion.h;
      gains_.take_work(cloth_of(place), work[lane] / scale);
    }
  }
}

/// Those of cloth that has gained more than is borne.
void SweptContacts::withhold_loads(double borne_j_kg) {
  for (std::size_t place = 0; place < contact_at_.size(); ++place) {
    if (contact_at_[place] == ContactGroups::kNobody || !gains_.exceed_at(cloth_of(place), borne_j_kg)) continue;
    states_[place / kLanes].withheld |= only_lane(place % kLanes);
  }
}

/// A vertex of cloth of the contact.
VertexId SweptContacts::cloth_of(std::size_t place) const {
  return *std::ranges::find_if(contact_at(place).interaction.vertices,
                               [&](VertexId v) { return held_.surface().is_cloth(v); });
}

/// What they bore in the last step, before anything else, where they are now.
SweptContacts::Refused SweptContacts::bear_pack(std::size_t id, LaneMask lanes, const Reach& reach,
                                                const ContactMotion& motion) {
  PackState& state = states_[id];
  fetch(id + 1, 0);
  lanes &= static_cast<LaneMask>(state.loaded & ~state.withheld);
  if (lanes == 0) return {};
  PackMotion read;
  read_motion(packs_[id], lanes, motion, read);
  LaneMask acting = lanes;
  const Refused refused = look_again(id, reach, motion, read, acting);
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    if (!has_lane(lanes, lane) || has_lane(acting | refused.out_of_reach | refused.at_once, lane)) continue;
    begin_with({}, id * kLanes + lane);
  }
  if (acting == 0) return refused;
  bear_loads(read, acting, packs_[id], motion);
  state.has_acted = true;
  return refused;
}

/// What is missing; or takes back what was too much, down to nothing.
SweptContacts::Refused SweptContacts::press_pack(std::size_t id, LaneMask lanes, const Reach& reach, int left,
                                                 const ContactMotion& motion) {
  ContactPack& pack = packs_[id];
  fetch(backwards_ ? id - 1 : id + 1, offsetof(ContactPack, mobility));
  PackMotion read;
  read_motion(pack, lanes, motion, read);
  const LaneMask looked_at = lanes & (states_[id].loaded | pressing(id));
  LaneMask pressed = newly_pressed(pack, read, lanes);
  const Refused refused = pressed == 0 ? Refused{} : look_again(id, reach, motion, read, pressed);
  const LaneMask acting = looked_at | pressed;
  if (acting == 0) return refused;
  const bool is_last = left == 1;
  const double relaxation = is_last || left > held_.sweeps() ? 1 : kOverRelaxation;
  press(read, acting, relaxation, is_last, pack, motion);
  states_[id].has_acted = true;
  return refused;
}

void SweptContacts::finish() {
  each_pack([&](std::size_t id) {
    const ContactPack& pack = packs_[id];
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const std::size_t i = contact_at_[id * kLanes + lane];
      if (i == ContactGroups::kNobody) continue;
      RepulsionContact& contact = held_.contact(i);
      contact.normal = vector_in(pack.normal, lane);
      for (std::size_t k = 0; k < 4; ++k) contact.interaction.weights[k] = pack.weights[k][lane];
      contact.is_beyond = has_lane(states_[id].beyond, lane);
      held_.set_load(i, {pack.load_m_s2[lane], vector_in(pack.friction_m_s2, lane)}, has_lane(pack.ever_repelled, lane),
                     has_lane(pack.ever_rubbed, lane));
    }
  });
  std::vector<std::size_t> order;
  std::ranges::copy_if(contact_at_, std::back_inserter(order),
                       [](std::size_t i) { return i != ContactGroups::kNobody; });
  held_.act_in(std::move(order));
}

}  // namespace selvage::sim
