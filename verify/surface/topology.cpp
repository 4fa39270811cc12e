#include "verify/surface/topology.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>
#include <string>

namespace selvage::verify {
namespace {

enum class Owner : std::uint8_t { kNone, kBody, kCloth };

Parts parts(const std::vector<Owner>& owners) {
  Parts result;
  result.cloth.reserve(static_cast<std::size_t>(std::count(owners.begin(), owners.end(), Owner::kCloth)));
  result.body.reserve(static_cast<std::size_t>(std::count(owners.begin(), owners.end(), Owner::kBody)));
  for (std::size_t i = 0; i < owners.size(); ++i) {
    if (owners[i] == Owner::kCloth) result.cloth.push_back(static_cast<std::int32_t>(i));
    if (owners[i] == Owner::kBody) result.body.push_back(static_cast<std::int32_t>(i));
  }
  return result;
}

/// Of a face; kNone where it is ignored.
Owner owner_of(const Surface& surface, std::size_t f) {
  if (!surface.is_ignored.empty() && surface.is_ignored[f] != 0) return Owner::kNone;
  return !surface.is_body.empty() && surface.is_body[f] != 0 ? Owner::kBody : Owner::kCloth;
}

std::int32_t representative(const Surface& surface, std::int32_t v) {
  return surface.representatives.empty() ? v : surface.representatives[static_cast<std::size_t>(v)];
}

/// Otherwise a face would have neighbours by its edges and vertices that it does not have by its corners.
bool names_representatives(const Surface& surface, const std::array<std::int32_t, 3>& face) {
  return std::all_of(face.begin(), face.end(), [&](std::int32_t v) {
    return std::find(face.begin(), face.end(), representative(surface, v)) != face.end();
  });
}

// As many edges as fit into their numbers, where no two faces share one.
constexpr std::size_t kMaxFaceCount = std::numeric_limits<std::int32_t>::max() / 3;

void check_faces(const Surface& surface, std::size_t vertex_count) {
  if (surface.triangles.size() > kMaxFaceCount) {
    throw std::invalid_argument("Surface: more than " + std::to_string(kMaxFaceCount) + " faces");
  }
  if (!surface.is_body.empty() && surface.is_body.size() != surface.triangles.size()) {
    throw std::invalid_argument("Surface: is_body must be empty or have one entry a face");
  }
  if (!surface.is_ignored.empty() && surface.is_ignored.size() != surface.triangles.size()) {
    throw std::invalid_argument("Surface: is_ignored must be empty or have one entry a face");
  }
  if (!surface.representatives.empty() && surface.representatives.size() != vertex_count) {
    throw std::invalid_argument("Surface: representatives must be empty or have one entry a vertex");
  }
  const auto face_count = static_cast<std::int32_t>(surface.triangles.size());
  for (const Exemption& exemption : surface.exemptions) {
    for (const FaceSet* const faces : {&exemption.a, &exemption.b}) {
      for (const auto& [begin, end] : *faces) {
        if (begin < 0 || begin > end || end > face_count) {
          throw std::invalid_argument("Surface: an exemption names faces that do not exist");
        }
      }
    }
  }
  for (std::size_t f = 0; f < surface.triangles.size(); ++f) {
    const auto& [a, b, c] = surface.triangles[f];
    for (const std::int32_t v : {a, b, c}) {
      if (v < 0 || static_cast<std::size_t>(v) >= vertex_count) {
        throw std::invalid_argument(
            "Surface: a face names a vertex that does not exist; pass positions of all vertices of the mesh");
      }
    }
    const bool repeats = a == b || b == c || c == a;
    if (repeats && owner_of(surface, f) != Owner::kNone)
      throw std::invalid_argument("Surface: a face repeats a corner");
    if (!names_representatives(surface, surface.triangles[f])) {
      throw std::invalid_argument("Surface: a face does not name the representatives of its corners");
    }
  }
}

struct OwnedEdge {
  std::int32_t larger, smaller;
  Owner owner;
  std::int32_t face;
};

/// Labels for edges and vertices from those of the faces that hold them. REQUIRES sides sorted as the edges.
void label_elements(const Surface& surface, const std::vector<OwnedEdge>& sides, Topology& topology) {
  ExemptionTable& exemptions = topology.exemptions;
  topology.face_labels = exemptions.face_labels();
  topology.vertex_labels.assign(static_cast<std::size_t>(topology.vertex_count), kNoLabel);
  topology.edge_labels.assign(topology.edges.size(), kNoLabel);
  std::size_t edge = 0;
  for (const OwnedEdge& side : sides) {
    if (topology.edges[edge] != std::array{side.smaller, side.larger}) ++edge;
    if (side.owner == Owner::kNone) continue;
    Label& held = topology.edge_labels[edge];
    held = exemptions.unite(held, topology.face_labels[static_cast<std::size_t>(side.face)]);
  }
  for (std::size_t f = 0; f < surface.triangles.size(); ++f) {  // not by sides: a face that is a point has none
    if (owner_of(surface, f) == Owner::kNone) continue;
    for (const std::int32_t corner : surface.triangles[f]) {
      Label& held = topology.vertex_labels[static_cast<std::size_t>(representative(surface, corner))];
      held = exemptions.unite(held, topology.face_labels[f]);
    }
  }
  exemptions.close();
}

}  // namespace

Topology make_topology(const Surface& surface, std::size_t vertex_count) {
  check_faces(surface, vertex_count);
  Topology topology;
  topology.vertex_count = static_cast<std::int64_t>(vertex_count);
  topology.triangles.assign(surface.triangles.begin(), surface.triangles.end());

  std::vector<Owner> face_owners, vertex_owners(vertex_count, Owner::kNone), edge_owners;
  std::vector<std::uint8_t> is_held(vertex_count, 0);
  std::vector<OwnedEdge> sides;
  sides.reserve(3 * surface.triangles.size());
  for (std::size_t f = 0; f < surface.triangles.size(); ++f) {
    const Owner owner = owner_of(surface, f);
    face_owners.push_back(owner);
    const auto& corners = surface.triangles[f];
    for (std::size_t i = 0; i < 3; ++i) {
      const std::int32_t corner = representative(surface, corners[i]),
                         next = representative(surface, corners[(i + 1) % 3]);
      Owner& vertex_owner = vertex_owners[static_cast<std::size_t>(corner)];
      vertex_owner = std::max(vertex_owner, owner);
      is_held[static_cast<std::size_t>(corner)] = 1;
      const auto [smaller, larger] = std::minmax(corner, next);
      if (smaller != larger) sides.push_back({larger, smaller, owner, static_cast<std::int32_t>(f)});
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
  topology.edges.shrink_to_fit();
  topology.faces = parts(face_owners);
  topology.edge_parts = parts(edge_owners);
  topology.vertices = parts(vertex_owners);
  for (std::size_t v = 0; v < vertex_count; ++v) {
    const auto vertex = static_cast<std::int32_t>(v);
    if (is_held[v] == 0 && representative(surface, vertex) == vertex) ++topology.unreferenced_vertices;
  }
  topology.exemptions = ExemptionTable(surface.exemptions, surface.is_body, surface.triangles.size());
  if (!topology.exemptions.empty()) label_elements(surface, sides, topology);
  return topology;
}

bool owes_pairs(const Topology& topology, bool check_bodies) {
  struct Kind {
    bool is_body;
    Label label;
    bool operator<(const Kind& other) const {
      return is_body != other.is_body ? is_body < other.is_body : label < other.label;
    }
  };
  std::map<Kind, std::int64_t> counts;
  for (const bool is_body : {false, true}) {
    for (const std::int32_t f : is_body ? topology.faces.body : topology.faces.cloth) {
      ++counts[{is_body, topology.exemptions.empty() ? kNoLabel : topology.face_labels[static_cast<std::size_t>(f)]}];
    }
  }
  for (const auto& [x, x_count] : counts) {
    for (const auto& [y, y_count] : counts) {
      const bool has_pair = x_count > 1 || x < y || y < x;
      const bool is_left_out = x.is_body && y.is_body && !check_bodies;
      const bool is_exempt =
          !topology.exemptions.empty() && topology.exemptions.exemption(x.label, y.label, check_bodies) >= 0;
      if (has_pair && !is_left_out && !is_exempt) return true;
    }
  }
  return false;
}

namespace {

/// Vertices that are looked at to tell where most are. Which is a matter of speed alone.
constexpr std::size_t kSampled = 1024;
/// The part of them, on each side of each axis, that may be far.
constexpr std::size_t kFarPart = 8;
/// Lengths of the box of the others to each side of it that are not far. What is not far loses as many bits of the 24
/// of the frame check's filter.
constexpr double kFar = 64;

Box bulk_box(const std::vector<Point>& points) {
  const Box all = bounding_box(points);
  const std::size_t stride = (points.size() + kSampled - 1) / kSampled;
  Box most{};
  double half_length = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    std::vector<double> x;
    for (std::size_t i = 0; i < points.size(); i += stride) x.push_back(points[i][k]);
    const auto far = static_cast<std::ptrdiff_t>(x.size() / kFarPart);
    std::ranges::nth_element(x, x.begin() + far);
    most.min[k] = x[static_cast<std::size_t>(far)];
    std::ranges::nth_element(x, x.end() - 1 - far);
    most.max[k] = *(x.end() - 1 - far);
    half_length = std::max(half_length, most.max[k] / 2 - most.min[k] / 2);
  }
  if (!(half_length > 0)) return all;
  Box bulk{};
  for (std::size_t k = 0; k < 3; ++k) {
    bulk.min[k] = std::max(all.min[k], most.min[k] - 2 * kFar * half_length);
    bulk.max[k] = std::min(all.max[k], most.max[k] + 2 * kFar * half_length);
  }
  return bulk;
}

}  // namespace

Box bulk_box(const Topology& topology, std::span<const Point> V) {
  std::vector<Point> held;
  held.reserve(topology.vertices.cloth.size() + topology.vertices.body.size());
  for (const std::vector<std::int32_t>* part : {&topology.vertices.cloth, &topology.vertices.body}) {
    for (const std::int32_t v : *part) held.push_back(V[static_cast<std::size_t>(v)]);
  }
  return held.empty() ? Box{} : bulk_box(held);
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
