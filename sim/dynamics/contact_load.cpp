#include "sim/dynamics/contact_load.h"

#include <algorithm>
#include <utility>

namespace selvage::sim {
namespace {

std::pair<std::int32_t, std::int32_t> pair_of(const ContactLoad& load) { return {load.first, load.second}; }

bool share_corner(const Mesh& mesh, FaceId a, FaceId b) {
  const auto& of_a = mesh.faces[static_cast<std::size_t>(a)];
  const auto& of_b = mesh.faces[static_cast<std::size_t>(b)];
  return std::ranges::find_first_of(of_a, of_b) != of_a.end();
}

}  // namespace

const ContactLoad* find_load(const ContactLoads& loads, PairKind kind, std::int32_t first, std::int32_t second,
                             const Mesh& mesh) {
  const bool is_vf = kind == PairKind::kVf;
  const std::vector<ContactLoad>& all = is_vf ? loads.vf : loads.ee;
  const auto begin = std::ranges::lower_bound(all, first, {}, &ContactLoad::first);
  const auto end = std::ranges::upper_bound(begin, all.end(), first, {}, &ContactLoad::first);
  auto load = std::ranges::find(begin, end, second, &ContactLoad::second);
  const auto is_beside = [&](const ContactLoad& l) { return share_corner(mesh, l.second, second); };
  if (load == end && is_vf) load = std::ranges::find_if(begin, end, is_beside);
  return load == end ? nullptr : &*load;
}

void keep_one_of_each_pair(std::vector<ContactLoad>& loads) {
  std::ranges::stable_sort(loads, {}, pair_of);
  const auto same = [](const ContactLoad& a, const ContactLoad& b) { return pair_of(a) == pair_of(b); };
  loads.erase(std::unique(loads.begin(), loads.end(), same), loads.end());
}

}  // namespace selvage::sim
