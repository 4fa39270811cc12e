#include "sim/contact_table.h"

#include <algorithm>
#include <utility>

namespace selvage::sim {
namespace {

InputError validate(const Mesh& mesh, const ContactSurfaces& surfaces) {
  if (!std::ranges::all_of(surfaces.properties, is_valid)) return InputError::kBadOption;
  if (surfaces.surface_of_vertex.size() != static_cast<std::size_t>(mesh.vertex_count)) {
    return InputError::kBadSurfaces;
  }
  const auto count = static_cast<std::int32_t>(surfaces.properties.size());
  const auto is_surface = [count](std::int32_t surface) { return surface >= 0 && surface < count; };
  if (!std::ranges::all_of(surfaces.surface_of_vertex, is_surface)) return InputError::kBadSurfaces;
  const auto surface = [&](VertexId v) { return surfaces.surface_of_vertex[static_cast<std::size_t>(v)]; };
  const auto is_of_one = [&](const auto& face) {
    return surface(face[0]) == surface(face[1]) && surface(face[1]) == surface(face[2]);
  };
  return std::ranges::all_of(mesh.faces, is_of_one) ? InputError::kNone : InputError::kBadSurfaces;
}

}  // namespace

ContactTable::ContactTable(const Mesh& mesh, const CollisionOptions& options, ContactSurfaces surfaces) {
  const bool has_surfaces = !surfaces.properties.empty() || !surfaces.surface_of_vertex.empty();
  if (has_surfaces) {
    error_ = validate(mesh, surfaces);
    properties_ = std::move(surfaces.properties);
  } else {
    properties_ = {contact_of(options)};
  }
  if (error_ != InputError::kNone) return;
  if (properties_.empty()) properties_.emplace_back();  // a mesh without vertices has no pairs
  const bool differ = std::ranges::adjacent_find(properties_, std::ranges::not_equal_to()) != properties_.end();
  if (differ) surface_ = std::move(surfaces.surface_of_vertex);
  for (const ContactProperties& p : properties_) {
    thickness_upper_ = std::max(thickness_upper_, p.thickness_m);
    tolerance_upper_ = std::max(tolerance_upper_, p.tolerance_m);
  }
}

ContactProperties ContactTable::of(PairKind kind, const std::array<VertexId, 4>& pair) const {
  if (is_uniform()) return properties_.front();
  const auto surface = [this](VertexId v) { return static_cast<std::size_t>(surface_[static_cast<std::size_t>(v)]); };
  const std::size_t first = surface(pair[0]), second = surface(pair[kind == PairKind::kEe ? 2 : 1]);
  return first == second ? properties_[first] : combine(properties_[first], properties_[second]);
}

}  // namespace selvage::sim
