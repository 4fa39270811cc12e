// Meshes and sequences as plain numbers, the only thing that crosses between rooms: vertex doubles and index triples.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace selvage::io {

using Points = std::vector<std::array<double, 3>>;           ///< #V by 3, caller's length unit
using Triangles = std::vector<std::array<std::int32_t, 3>>;  ///< #F by 3, each < #V

enum class Precision { kFloat64, kFloat32 };  ///< what the file stores; float32 values are exact doubles

/// Faces [begin, end) that belong together.
struct Group {
  enum class Role { kCloth, kBody };
  std::string name;
  Role role = Role::kCloth;
  std::int32_t face_begin = 0, face_end = 0;

  friend bool operator==(const Group&, const Group&) = default;
};

/// Whether the group names some of that many faces, or none.
[[nodiscard]] inline bool is_within(const Group& group, std::size_t face_count) {
  return 0 <= group.face_begin && group.face_begin <= group.face_end &&
         static_cast<std::size_t>(group.face_end) <= face_count;
}

/// Of each of `face_count` faces: 1 where a group with the role of a body has it, else 0. O(faces). REQUIRES groups
/// within the faces.
[[nodiscard]] std::vector<std::uint8_t> body_faces(std::size_t face_count, const std::vector<Group>& groups);

/// A face of a body and of the cloth could be taken for either, and is owed less as a body's. Throws Error(kBadInput)
/// where there is one: "NAME: face ...".
void require_one_role(const std::vector<Group>& groups, const std::string& name);

struct MeshData {
  Points points;
  Triangles triangles;
  std::vector<Group> groups;  ///< empty: one anonymous cloth
  Precision precision = Precision::kFloat64;
  std::int64_t split_polygons = 0;  ///< faces of the file with more corners than three: each became several triangles
};

}  // namespace selvage::io
