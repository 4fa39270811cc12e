#include "io/mesh_data.h"

#include <algorithm>
#include <utility>

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
  const auto is_in = [](const Group& group, Group::Role role) {
    return group.role == role && group.face_begin < group.face_end;
  };
  // The faces of the cloth as ranges apart from each other: to compare all pairs of groups would take minutes for as
  // many as a file may hold.
  std::vector<std::pair<std::int32_t, std::int32_t>> all, apart;
  for (const Group& group : groups) {
    if (is_in(group, Group::Role::kCloth)) all.emplace_back(group.face_begin, group.face_end);
  }
  std::ranges::sort(all);
  for (const auto& range : all) {
    if (apart.empty() || apart.back().second < range.first) apart.push_back(range);
    apart.back().second = std::max(apart.back().second, range.second);
  }
  for (const Group& body : groups) {
    if (!is_in(body, Group::Role::kBody)) continue;
    const auto meets = [&](std::int32_t begin, std::int32_t end) {
      return std::max(begin, body.face_begin) < std::min(end, body.face_end);
    };
    const auto next =
        std::ranges::upper_bound(apart, body.face_begin, {}, &std::pair<std::int32_t, std::int32_t>::second);
    if (next == apart.end() || !meets(next->first, next->second)) continue;
    const auto cloth = std::ranges::find_if(groups, [&](const Group& group) {
      return group.role == Group::Role::kCloth && meets(group.face_begin, group.face_end);
    });
    bad_input(name, "face " + std::to_string(std::max(body.face_begin, cloth->face_begin)) + " is in the group \"" +
                        cloth->name + "\", which is cloth, and in \"" + body.name +
                        "\", which is a body; give both groups one role, or ranges that have no face in common");
  }
}

}  // namespace selvage::io
