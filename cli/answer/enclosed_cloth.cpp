#include "cli/answer/enclosed_cloth.h"

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "sim/contact/surface_parts.h"
#include "verify/decision/enclosed.h"

namespace selvage::cli {
namespace {

using Corner = std::array<double, 3>;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A connected part of the surface; of the group of its first face.
struct Part {
  std::size_t group = 0;
  bool is_body = true;  ///< all of it
  Corner lower = {kInfinity, kInfinity, kInfinity}, upper = {-kInfinity, -kInfinity, -kInfinity};
  io::Triangles faces;
  bool is_closed = true;
};

/// By their smallest vertex.
using Parts = std::map<VertexId, Part>;

/// The number of each face's group; that behind the last where it has none.
std::vector<std::size_t> group_of_faces(std::size_t face_count, const std::vector<io::Group>& groups) {
  std::vector<std::size_t> group_of(face_count, groups.size());
  for (std::size_t group = 0; group < groups.size(); ++group) {
    std::fill(group_of.begin() + groups[group].face_begin, group_of.begin() + groups[group].face_end, group);
  }
  return group_of;
}

Parts parts_of(const Mesh& mesh, const std::vector<io::Group>& groups, const io::Points& points) {
  const sim::SurfaceParts connected(mesh);
  const std::vector<std::size_t> group_of = group_of_faces(mesh.faces.size(), groups);
  Parts parts;
  std::vector<std::uint8_t> is_odd(mesh.edges.size(), 0);
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const auto& face = mesh.faces[f];
    Part& part = parts[connected.part(face[0])];
    if (part.faces.empty()) part.group = group_of[f];
    part.is_body = part.is_body && group_of[f] < groups.size() && groups[group_of[f]].role == io::Group::Role::kBody;
    part.faces.push_back(face);
    for (const VertexId v : face) {
      for (std::size_t k = 0; k < 3; ++k) {
        const double x = points[static_cast<std::size_t>(v)][k];
        part.lower[k] = std::min(part.lower[k], x);
        part.upper[k] = std::max(part.upper[k], x);
      }
    }
    for (const EdgeId e : mesh.face_edges[f]) is_odd[static_cast<std::size_t>(e)] ^= 1;
  }
  for (std::size_t e = 0; e < is_odd.size(); ++e) {
    if (is_odd[e] != 0) parts.at(connected.part(mesh.edges[e][0])).is_closed = false;
  }
  return parts;
}

bool is_within(const Part& inner, const Part& outer) {
  for (std::size_t k = 0; k < 3; ++k) {
    if (!(inner.lower[k] > outer.lower[k] && inner.upper[k] < outer.upper[k])) return false;
  }
  return true;
}

/// Nothing where a body has faces of which no mesh can be made.
std::vector<EnclosedCloth> enclosed_in_frame(const io::MeshData& frame) {
  const auto count = static_cast<std::int32_t>(frame.points.size());
  const Eigen::Map<const Faces> faces(frame.triangles.empty() ? nullptr : frame.triangles.front().data(),
                                      std::ssize(frame.triangles), 3);
  if (validate_faces(count, faces) != InputError::kNone) return {};
  return find_enclosed(make_mesh(count, faces), frame.groups, frame.points);
}

}  // namespace

std::vector<EnclosedCloth> find_enclosed(const Mesh& mesh, const std::vector<io::Group>& groups,
                                         const io::Points& points) {
  if (std::ranges::count(groups, io::Group::Role::kBody, &io::Group::role) == 0) return {};
  const Parts parts = parts_of(mesh, groups, points);
  std::map<std::size_t, int> part_count;
  std::map<std::pair<std::size_t, std::size_t>, int> enclosed;  // parts, by cloth and body
  for (const auto& [vertex, cloth] : parts) {
    if (cloth.is_body) continue;
    ++part_count[cloth.group];
    std::map<std::size_t, bool> bodies;
    for (const auto& [other, body] : parts) {
      if (!body.is_body || !body.is_closed || bodies[body.group] || !is_within(cloth, body)) continue;
      bodies[body.group] = verify::is_enclosed(points[static_cast<std::size_t>(vertex)], body.faces, points);
    }
    for (const auto& [body, is_inside] : bodies) {
      if (is_inside) ++enclosed[{cloth.group, body}];
    }
  }
  std::vector<EnclosedCloth> found;
  for (const auto& [pair, count] : enclosed) {
    const auto& [cloth, body] = pair;
    const int all = part_count[cloth];
    const std::string some = count < all ? fmt::format("{} of {} connected parts of ", count, all) : "";
    const std::string name = cloth < groups.size() ? fmt::format("\"{}\"", groups[cloth].name) : "what is in no group";
    found.push_back({some + name, fmt::format("\"{}\"", groups[body].name)});
  }
  return found;
}

std::vector<std::string> notes_on_enclosed(const io::SequenceReader& sequence, std::size_t first, std::size_t last) {
  const std::vector<EnclosedCloth> at_first = enclosed_in_frame(sequence.frame(first));
  const std::vector<EnclosedCloth> at_last = first < last ? enclosed_in_frame(sequence.frame(last)) : at_first;
  std::vector<std::string> notes;
  const auto note = [&](const EnclosedCloth& pair, std::size_t frame, std::size_t other, bool is_in_other) {
    notes.push_back(fmt::format(
        "{} is wholly inside the closed body {} in frame {}, where it meets nothing, which is no violation{}",
        pair.cloth, pair.body, sequence.frame_name(frame),
        is_in_other ? ""
                    : fmt::format("; but not in frame {}: it came through between them, and --motion says where",
                                  sequence.frame_name(other))));
  };
  const auto is_in = [](const std::vector<EnclosedCloth>& all, const EnclosedCloth& pair) {
    return std::ranges::find(all, pair) != all.end();
  };
  for (const EnclosedCloth& pair : at_first) note(pair, first, last, is_in(at_last, pair));
  for (const EnclosedCloth& pair : at_last) {
    if (!is_in(at_first, pair)) note(pair, last, first, false);
  }
  return notes;
}

}  // namespace selvage::cli
