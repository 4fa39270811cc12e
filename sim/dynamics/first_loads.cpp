#include "sim/dynamics/first_loads.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "sim/base/parallel.h"

namespace selvage::sim {
namespace {

std::ranges::subrange<std::vector<ContactLoad>::const_iterator> loads_of_first(const RepulsionContact& contact,
                                                                               const std::vector<ContactLoad>& loads) {
  return std::ranges::equal_range(loads, contact.first, {}, &ContactLoad::first);
}

const ContactLoad* own_load(const RepulsionContact& contact, const ContactLoads& loads) {
  const auto of_first = loads_of_first(contact, contact.kind == PairKind::kVf ? loads.vf : loads.ee);
  const auto load = std::ranges::find(of_first, contact.second, &ContactLoad::second);
  return load == of_first.end() ? nullptr : &*load;
}

/// The first of its vertex on a face beside.
const ContactLoad* load_beside(const RepulsionContact& contact, const ContactLoads& loads,
                               std::span<const std::array<VertexId, 3>> faces) {
  if (contact.kind != PairKind::kVf) return nullptr;
  const auto& face = faces[static_cast<std::size_t>(contact.second)];
  const auto is_beside = [&](const ContactLoad& load) {
    const auto& other = faces[static_cast<std::size_t>(load.second)];
    return std::ranges::find_first_of(other, face) != other.end();
  };
  const auto of_first = loads_of_first(contact, loads.vf);
  const auto load = std::ranges::find_if(of_first, is_beside);
  return load == of_first.end() ? nullptr : &*load;
}

}  // namespace

std::vector<ContactLoad> first_loads(std::span<const RepulsionContact> contacts, const ContactLoads& loads,
                                     std::span<const std::array<VertexId, 3>> faces) {
  std::vector<const ContactLoad*> own(contacts.size()), beside(contacts.size());
  parallel_each(std::ssize(contacts), [&](Eigen::Index at) {
    const auto i = static_cast<std::size_t>(at);
    own[i] = own_load(contacts[i], loads);
    if (own[i] == nullptr) beside[i] = load_beside(contacts[i], loads, faces);
  });
  std::vector<std::int32_t> takers(loads.vf.size());
  const auto place = [&](const ContactLoad* load) { return static_cast<std::size_t>(load - loads.vf.data()); };
  for (const ContactLoad* load : beside) {
    if (load != nullptr) ++takers[place(load)];
  }
  std::vector<ContactLoad> result(contacts.size());
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    if (own[i] != nullptr) result[i] = *own[i];
    if (beside[i] == nullptr) continue;
    const double share = 1.0 / takers[place(beside[i])];
    result[i] = *beside[i];
    result[i].acceleration_m_s2 *= share;
    for (double& friction : result[i].friction_m_s2) friction *= share;
  }
  return result;
}

}  // namespace selvage::sim
