#include "sim/dynamics/held_contacts.h"

#include <array>
#include <numeric>
#include <utility>

#include "sim/base/parallel.h"

namespace selvage::sim {

HeldContacts::HeldContacts(std::vector<RepulsionContact> contacts, const ContactLoads& loads,
                           const HeldSurface& surface, const Positions& V_t0, const Positions& V_t1, double dt_s,
                           std::int32_t sweeps)
    : surface_(surface),
      V_t0_(V_t0),
      V_t1_(V_t1),
      dt_s_(dt_s),
      sweeps_(sweeps),
      contacts_(std::move(contacts)),
      borne_(contacts_.size()),
      order_(contacts_.size()) {
  std::iota(order_.begin(), order_.end(), std::size_t{0});
  parallel_each(std::ssize(contacts_), [&](Eigen::Index at) {
    const auto i = static_cast<std::size_t>(at);
    const RepulsionContact& contact = contacts_[i];
    const ContactLoad* const load = find_load(loads, contact.kind, contact.first, contact.second, surface_.mesh);
    if (load != nullptr) borne_[i].load = {load->acceleration_m_s2, Vec3(load->friction_m_s2.data())};
  });
}

void HeldContacts::set_load(std::size_t i, const Load& load, bool has_repelled, bool has_rubbed) {
  Borne& borne = borne_[i];
  borne.load = load;
  borne.has_repelled = borne.has_repelled || has_repelled;
  borne.has_rubbed = borne.has_rubbed || has_rubbed;
}

std::vector<RepulsionContact> HeldContacts::take_contacts() && {
  parallel_each(std::ssize(contacts_), [&](Eigen::Index at) {
    RepulsionContact& contact = contacts_[static_cast<std::size_t>(at)];
    contact.x_t0 = gather(contact.interaction, V_t0_);
    contact.distance = relative(contact.interaction, contact.x_t0).dot(contact.normal);
    contact.mobility = effective_mobility(contact.interaction);
  });
  return std::move(contacts_);
}

RepulsionCount HeldContacts::count() const {
  RepulsionCount result;
  for (const Borne& borne : borne_) {
    result.repulsions += borne.has_repelled ? 1 : 0;
    result.frictions += borne.has_rubbed ? 1 : 0;
  }
  return result;
}

Candidates HeldContacts::repelled_pairs() const {
  Candidates result;
  for (std::size_t i = 0; i < contacts_.size(); ++i) {
    if (borne_[i].has_repelled) add_pair(contacts_[i], result);
  }
  sort_pairs(result);
  return result;
}

ContactLoads HeldContacts::loads() const {
  ContactLoads result;
  for (const std::size_t i : order_) {
    const RepulsionContact& contact = contacts_[i];
    const auto& [along_m_s2, friction_m_s2] = borne_[i].load;
    if (!(along_m_s2 > 0)) continue;
    const std::array<double, 3> friction{friction_m_s2.x(), friction_m_s2.y(), friction_m_s2.z()};
    (contact.kind == PairKind::kVf ? result.vf : result.ee)
        .push_back({contact.first, contact.second, along_m_s2, friction});
  }
  keep_one_of_each_pair(result.vf);
  keep_one_of_each_pair(result.ee);
  return result;
}

}  // namespace selvage::sim
