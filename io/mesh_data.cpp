#include "io/mesh_data.h"

#include <algorithm>

#include "io/fail.h"

namespace selvage::io {

std::vector<std::uint8_t> body_faces(std::size_t face_count, const std::vector<Group>& groups) {
  std::vector<std::uint8_t> is_body(face_count, 0);
  for (const Group& group : groups) {
    if (group.role != Group::Role::kBody) continue;
    std::fill(is_body.begin() + group.face_begin, is_body.begin() + group.face_end, std::uint8_t{1});
  }
  return is_body;
}

void require_one_role(const std::vector<Group>& groups, const std::string& name) {
  for (const Group& body : groups) {
    if (body.role != Group::Role::kBody) continue;
    for (const Group& cloth : groups) {
      const std::int32_t face = std::max(body.face_begin, cloth.face_begin);
      if (cloth.role == Group::Role::kBody || face >= std::min(body.face_end, cloth.face_end)) continue;
      bad_input(name, "face " + std::to_string(face) + " is in the group \"" + cloth.name +
                          "\", which is cloth, and in \"" + body.name +
                          "\", which is a body; give both groups one role, or ranges that have no face in common");
    }
  }
}

}  // namespace selvage::io
