#include "sim/bodies/joined_faces.h"

#include <algorithm>
#include <array>
#include <map>
#include <vector>

#include "sim/scene/shapes.h"

namespace selvage::sim {
namespace {

using Face = std::array<VertexId, 3>;
/// In ascending order; the same twice is a vertex.
using Segment = std::array<VertexId, 2>;

VertexId at(std::span<const VertexId> first, VertexId vertex) { return first[static_cast<std::size_t>(vertex)]; }

bool names_one_twice(const Face& face) { return face[0] == face[1] || face[1] == face[2] || face[2] == face[0]; }

Segment what_is_left(const Face& collapsed) {
  const auto [smallest, largest] = std::ranges::minmax(collapsed);
  return {smallest, largest};
}

/// How many faces hold each of the segments that faces have become.
class Holders {
 public:
  explicit Holders(const io::Triangles& named) {
    for (const Face& face : named) {
      if (names_one_twice(face)) count_[what_is_left(face)] = 0;
    }
    if (count_.empty()) return;
    for (const Face& face : named) change(face, 1);
  }

  /// Whether another one holds what is left of this face, which then is forgotten.
  bool give_up(const Face& collapsed) {
    if (count_.at(what_is_left(collapsed)) < 2) return false;
    change(collapsed, -1);
    return true;
  }

 private:
  void change(const Face& face, int by) {
    std::array<Segment, 6> held{};  // some of them twice where it names a vertex twice
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [smaller, larger] = std::minmax(face[k], face[(k + 1) % 3]);
      held[k] = {smaller, larger};
      held[k + 3] = {face[k], face[k]};
    }
    std::ranges::sort(held);
    const auto end = std::unique(held.begin(), held.end());
    for (auto segment = held.begin(); segment != end; ++segment) {
      if (const auto found = count_.find(*segment); found != count_.end()) found->second += by;
    }
  }

  std::map<Segment, int> count_;
};

/// The lowest corner at each place has the place's name.
Face named_apart(const Face& face, std::span<const VertexId> first) {
  Face result = face;
  for (std::size_t k = 0; k < 3; ++k) {
    const bool is_lowest = std::ranges::none_of(
        face, [&](VertexId other) { return other < face[k] && at(first, other) == at(first, face[k]); });
    if (is_lowest) result[k] = at(first, face[k]);
  }
  return result;
}

}  // namespace

JoinedFaces join_faces(const io::Triangles& triangles, std::span<const VertexId> first) {
  io::Triangles named = triangles;
  for (Face& face : named) {
    for (VertexId& corner : face) corner = at(first, corner);
  }
  Holders holders(named);
  JoinedFaces joined;
  for (std::size_t f = 0; f < named.size(); ++f) {
    if (!names_one_twice(named[f])) {
      joined.triangles.push_back(named[f]);
    } else if (!holders.give_up(named[f])) {
      joined.triangles.push_back(named_apart(triangles[f], first));
    }
  }
  joined.left_out = static_cast<std::int32_t>(triangles.size() - joined.triangles.size());
  const std::vector<std::uint8_t> before = vertices_in_faces(triangles, first.size()),
                                  now = vertices_in_faces(joined.triangles, first.size());
  for (std::size_t v = 0; v < first.size(); ++v) joined.joined_vertices += before[v] != 0 && now[v] == 0 ? 1 : 0;
  return joined;
}

}  // namespace selvage::sim
