#include "verify/topology.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace selvage::verify {
namespace {

enum class Owner : std::uint8_t { kNone, kBody, kCloth };

Parts parts(const std::vector<Owner>& owners) {
  Parts result;
  for (std::size_t i = 0; i < owners.size(); ++i) {
    if (owners[i] == Owner::kCloth) result.cloth.push_back(static_cast<std::int32_t>(i));
    if (owners[i] == Owner::kBody) result.body.push_back(static_cast<std::int32_t>(i));
  }
  return result;
}

void check_faces(const Surface& surface, std::size_t vertex_count) {
  if (!surface.is_body.empty() && surface.is_body.size() != surface.triangles.size()) {
    throw std::invalid_argument("Surface: is_body must be empty or have one entry a face");
  }
  for (const auto& [a, b, c] : surface.triangles) {
    for (const std::int32_t v : {a, b, c}) {
      if (v < 0 || static_cast<std::size_t>(v) >= vertex_count) {
        throw std::invalid_argument("Surface: a face names a vertex that does not exist");
      }
    }
    if (a == b || b == c || c == a) throw std::invalid_argument("Surface: a face repeats a corner");
  }
}

struct OwnedEdge {
  std::int32_t larger, smaller;
  Owner owner;
};

}  // namespace

Topology make_topology(const Surface& surface, std::size_t vertex_count) {
  check_faces(surface, vertex_count);
  Topology topology;
  topology.vertex_count = static_cast<std::int64_t>(vertex_count);
  topology.triangles.assign(surface.triangles.begin(), surface.triangles.end());

  std::vector<Owner> face_owners, vertex_owners(vertex_count, Owner::kNone), edge_owners;
  std::vector<OwnedEdge> sides;
  sides.reserve(3 * surface.triangles.size());
  for (std::size_t f = 0; f < surface.triangles.size(); ++f) {
    const Owner owner = !surface.is_body.empty() && surface.is_body[f] != 0 ? Owner::kBody : Owner::kCloth;
    face_owners.push_back(owner);
    const auto& corners = surface.triangles[f];
    for (std::size_t i = 0; i < 3; ++i) {
      Owner& vertex_owner = vertex_owners[static_cast<std::size_t>(corners[i])];
      vertex_owner = std::max(vertex_owner, owner);
      const auto [smaller, larger] = std::minmax(corners[i], corners[(i + 1) % 3]);
      sides.push_back({larger, smaller, owner});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const OwnedEdge& x, const OwnedEdge& y) {
    return x.larger != y.larger ? x.larger < y.larger : x.smaller < y.smaller;
  });
  for (const OwnedEdge& side : sides) {
    const std::array<std::int32_t, 2> edge = {side.smaller, side.larger};
    if (topology.edges.empty() || topology.edges.back() != edge) {
      topology.edges.push_back(edge);
      edge_owners.push_back(Owner::kNone);
    }
    edge_owners.back() = std::max(edge_owners.back(), side.owner);
  }
  topology.faces = parts(face_owners);
  topology.edge_parts = parts(edge_owners);
  topology.vertices = parts(vertex_owners);
  topology.unreferenced_vertices = std::count(vertex_owners.begin(), vertex_owners.end(), Owner::kNone);
  return topology;
}

void require_positions(const Topology& topology, std::span<const Point> V) {
  if (V.size() != static_cast<std::size_t>(topology.vertex_count)) {
    throw std::invalid_argument("a frame must have one position for every vertex of the surface");
  }
  for (const Point& p : V) {
    if (!std::isfinite(p[0]) || !std::isfinite(p[1]) || !std::isfinite(p[2])) {
      throw std::invalid_argument("a frame must have finite positions");
    }
  }
}

}  // namespace selvage::verify
