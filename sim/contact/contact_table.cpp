#include "sim/contact/contact_table.h"

#include <algorithm>
#include <utility>

#include "kernel/fp_env.h"

namespace selvage::sim {
namespace {

InputError validate(const Mesh& mesh, const ContactSurfaces& surfaces) {
  const auto is_of_surface = [](const ContactProperties& p) { return is_valid(p) && !p.is_of_rest; };
  if (!std::ranges::all_of(surfaces.properties, is_of_surface)) return InputError::kBadOption;
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

ContactTable::ContactTable(const Mesh& mesh, const CollisionOptions& options, ContactSurfaces surfaces) : mesh_(mesh) {
  const FpEnvGuard guard;
  const bool has_surfaces = !surfaces.properties.empty() || !surfaces.surface_of_vertex.empty();
  if (has_surfaces) {
    error_ = validate(mesh, surfaces);
    properties_ = std::move(surfaces.properties);
  } else {
    properties_ = {contact_of(options)};
  }
  if (error_ == InputError::kNone) error_ = sim::validate(mesh, surfaces.rest_pairs);
  if (error_ != InputError::kNone) return;
  if (properties_.empty()) properties_.emplace_back();  // a mesh without vertices has no pairs
  const bool differ = std::ranges::adjacent_find(properties_, std::ranges::not_equal_to()) != properties_.end();
  if (differ) surface_ = std::move(surfaces.surface_of_vertex);
  for (const ContactProperties& p : properties_) {
    thickness_upper_ = std::max(thickness_upper_, p.thickness_m);
    tolerance_upper_ = std::max(tolerance_upper_, p.tolerance_m);
  }
  rest_ = RestDistances(mesh, std::move(surfaces.rest_pairs));
}

ContactProperties ContactTable::of(PairKind kind, std::int32_t first, std::int32_t second) const {
  if (is_uniform()) return properties_.front();
  ContactProperties pair = of_surfaces(kind, first, second);
  const double rest_m = rest_.of(kind, first, second);
  pair.is_of_rest = rest_m < pair.thickness_m;
  pair.thickness_m = std::min(pair.thickness_m, rest_m);
  // What is nearer than the tolerance is pushed to twice as far (impulse.h): beyond where it rests, a sheet on which
  // nothing acted had 18 J/kg after a frame.
  pair.tolerance_m = std::min(pair.tolerance_m, rest_m / 2);
  return pair;
}

ContactProperties ContactTable::of_surfaces(PairKind kind, std::int32_t first, std::int32_t second) const {
  if (surface_.empty()) return properties_.front();
  const auto surface = [this](VertexId v) { return static_cast<std::size_t>(surface_[static_cast<std::size_t>(v)]); };
  const auto of_edge = [&](std::int32_t edge) { return surface(mesh_.edges[static_cast<std::size_t>(edge)][0]); };
  const bool are_edges = kind == PairKind::kEe;
  const std::size_t a = are_edges ? of_edge(first) : surface(first);
  const std::size_t b = are_edges ? of_edge(second) : surface(mesh_.faces[static_cast<std::size_t>(second)][0]);
  return a == b ? properties_[a] : combine(properties_[a], properties_[b]);
}

}  // namespace selvage::sim
