#include "sim/start_proximities.h"

#include <cstring>

#include "sim/local_proximities.h"
#include "sim/repulsion.h"

namespace selvage::sim {
namespace {

bool same_bits(const Positions& a, const Positions& b) {
  return a.rows() == b.rows() &&
         std::memcmp(a.data(), b.data(), static_cast<std::size_t>(a.size()) * sizeof(double)) == 0;
}

}  // namespace

void StartProximities::find(const Mesh& mesh, BoxHierarchy& hierarchy, const ContactTable& contacts,
                            const Positions& V_t0, const std::vector<std::uint8_t>& surface) {
  if (V_t0.rows() > 0 && same_bits(V_t0, V_t0_) && surface == surface_) return;
  V_t0_ = V_t0;
  surface_ = surface;
  const double reach = kContactReach * contacts.thickness_upper();
  std::vector<PairProximity> near = find_proximities(mesh, hierarchy, V_t0, reach, surface);
  if (!contacts.is_uniform()) {
    std::erase_if(near, [&](const PairProximity& pair) {
      const double thickness_m = contacts.of(pair.kind, pair.vertices).thickness_m;
      return !(pair.proximity.distance_lower < kContactReach * thickness_m);
    });
  }
  count_ = static_cast<std::int64_t>(near.size());
  local_ = local_proximities(mesh, V_t0, near);
}

}  // namespace selvage::sim
