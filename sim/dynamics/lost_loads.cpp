#include "sim/dynamics/lost_loads.h"

#include <algorithm>
#include <array>
#include <vector>

#include "sim/contact/cloth_sets.h"

namespace selvage::sim {
namespace {

std::array<VertexId, 4> vertices_of(const Mesh& mesh, PairKind kind, const ContactLoad& load) {
  return pair_vertices(mesh, kind, load.first, load.second);
}

}  // namespace

void forget_loads(std::span<const VertexId> without_room, const Candidates& pressed, const Mesh& mesh,
                  const SurfaceParts& parts, VertexId cloth_count, ContactLoads& loads) {
  if (without_room.empty()) return;
  ClothSets sets(parts, cloth_count);
  for (const VfCandidate& pair : pressed.vf) sets.join(pair_vertices(mesh, pair));
  for (const EeCandidate& pair : pressed.ee) sets.join(pair_vertices(mesh, pair));
  for (const ContactLoad& load : loads.vf) sets.join(vertices_of(mesh, PairKind::kVf, load));
  for (const ContactLoad& load : loads.ee) sets.join(vertices_of(mesh, PairKind::kEe, load));
  std::vector<std::uint8_t> is_full(static_cast<std::size_t>(cloth_count));  // by set
  for (const VertexId v : without_room) {
    if (sets.is_cloth(v)) is_full[sets.set(v)] = 1;
  }
  const auto forget = [&](PairKind kind, std::vector<ContactLoad>& of_kind) {
    std::erase_if(of_kind, [&](const ContactLoad& load) {
      return std::ranges::any_of(vertices_of(mesh, kind, load),
                                 [&](VertexId v) { return sets.is_cloth(v) && is_full[sets.set(v)] != 0; });
    });
  };
  forget(PairKind::kVf, loads.vf);
  forget(PairKind::kEe, loads.ee);
}

}  // namespace selvage::sim
