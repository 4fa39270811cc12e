#include "io/mesh_data.h"

#include <algorithm>

namespace selvage::io {

std::vector<std::uint8_t> body_faces(std::size_t face_count, const std::vector<Group>& groups) {
  std::vector<std::uint8_t> is_body(face_count, 0);
  for (const Group& group : groups) {
    if (group.role != Group::Role::kBody) continue;
    std::fill(is_body.begin() + group.face_begin, is_body.begin() + group.face_end, std::uint8_t{1});
  }
  return is_body;
}

}  // namespace selvage::io
