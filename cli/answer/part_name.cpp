#include "cli/answer/part_name.h"

#include <algorithm>
#include <span>

#include "io/file/text.h"

namespace selvage::cli {

const io::Group* part_with_face(const sim::World& world, FaceId face) {
  const auto part = std::ranges::find_if(
      world.groups, [face](const io::Group& group) { return face >= group.face_begin && face < group.face_end; });
  return part == world.groups.end() ? nullptr : &*part;
}

std::string part_of_face(const sim::World& world, FaceId face) {
  const io::Group* part = part_with_face(world, face);
  return part == nullptr ? "?" : io::printable(part->name);
}

std::string part_of_vertex(const sim::World& world, VertexId vertex) {
  return part_of_face(world, world.mesh.vertex_owner[static_cast<std::size_t>(vertex)]);
}

std::string pin_of_vertex(const sim::World& world, VertexId vertex, double time_s) {
  for (const sim::Collider& pin : std::span(world.colliders).subspan(static_cast<std::size_t>(world.body_count))) {
    if (pin.holds(time_s) && std::ranges::find(pin.vertices(), vertex) != pin.vertices().end()) {
      return io::printable(pin.name());
    }
  }
  return "";
}

}  // namespace selvage::cli
