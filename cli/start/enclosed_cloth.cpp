#include "cli/start/enclosed_cloth.h"

#include <limits>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "sim/base/points.h"
#include "sim/contact/surface_parts.h"
#include "verify/decision/enclosed.h"

namespace selvage::cli {
namespace {

/// A connected part of a group.
struct Part {
  std::size_t group = 0;
  Vec3 lower = Vec3::Constant(std::numeric_limits<double>::infinity());
  Vec3 upper = Vec3::Constant(-std::numeric_limits<double>::infinity());
  io::Triangles faces;
  bool is_closed = true;
};

/// By their smallest vertex.
using Parts = std::map<VertexId, Part>;

Parts parts_of(const sim::World& world, const Positions& x) {
  const sim::SurfaceParts connected(world.mesh);
  Parts parts;
  std::vector<std::uint8_t> is_odd(world.mesh.edges.size(), 0);
  for (std::size_t group = 0; group < world.groups.size(); ++group) {
    for (std::int32_t f = world.groups[group].face_begin; f < world.groups[group].face_end; ++f) {
      const auto& face = world.triangles[static_cast<std::size_t>(f)];
      Part& part = parts[connected.part(face[0])];
      part.group = group;
      part.faces.push_back(face);
      for (const VertexId v : face) {
        part.lower = part.lower.cwiseMin(x.row(v).transpose());
        part.upper = part.upper.cwiseMax(x.row(v).transpose());
      }
      for (const EdgeId e : world.mesh.face_edges[static_cast<std::size_t>(f)])
        is_odd[static_cast<std::size_t>(e)] ^= 1;
    }
  }
  for (std::size_t e = 0; e < is_odd.size(); ++e) {
    if (is_odd[e] != 0) parts.at(connected.part(world.mesh.edges[e][0])).is_closed = false;
  }
  return parts;
}

bool is_within(const Part& inner, const Part& outer) {
  return (inner.lower.array() > outer.lower.array()).all() && (inner.upper.array() < outer.upper.array()).all();
}

}  // namespace

std::vector<std::string> notes_on_enclosed(const sim::World& world, const Positions& x) {
  if (world.body_count == 0) return {};
  const Parts parts = parts_of(world, x);
  const io::Points points = sim::points_of(x);
  const auto is_body = [&](const Part& part) { return world.groups[part.group].role == io::Group::Role::kBody; };
  std::map<std::size_t, int> part_count;
  std::map<std::pair<std::size_t, std::size_t>, int> enclosed;  // parts, by cloth and body
  for (const auto& [vertex, cloth] : parts) {
    if (is_body(cloth)) continue;
    ++part_count[cloth.group];
    std::map<std::size_t, bool> bodies;
    for (const auto& [other, body] : parts) {
      if (!is_body(body) || !body.is_closed || bodies[body.group] || !is_within(cloth, body)) continue;
      bodies[body.group] = verify::is_enclosed(points[static_cast<std::size_t>(vertex)], body.faces, points);
    }
    for (const auto& [body, is_inside] : bodies) {
      if (is_inside) ++enclosed[{cloth.group, body}];
    }
  }
  std::vector<std::string> notes;
  for (const auto& [pair, count] : enclosed) {
    const auto& [cloth, body] = pair;
    const int all = part_count[cloth];
    notes.push_back(fmt::format(
        "{}\"{}\" starts inside the closed body \"{}\" without meeting it, which is taken as intended: it will stay "
        "inside; move it out if it was to be outside",
        count < all ? fmt::format("{} of {} connected parts of ", count, all) : "", world.groups[cloth].name,
        world.groups[body].name));
  }
  return notes;
}

}  // namespace selvage::cli
