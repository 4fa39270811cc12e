// What a triangle surface is made of, for tests of the shapes.
#pragma once

#include <array>
#include <cstdint>
#include <map>

#include "sim/scene/shapes.h"

namespace selvage::sim::testbed {

// Number of faces at each directed edge; a closed oriented surface has every edge once in each direction.
inline std::map<std::array<std::int32_t, 2>, int> directed_edges(const Shape& shape) {
  std::map<std::array<std::int32_t, 2>, int> count;
  for (const auto& t : shape.triangles) {
    for (std::size_t k = 0; k < 3; ++k) ++count[{t[k], t[(k + 1) % 3]}];
  }
  return count;
}

inline bool closed_and_oriented(const Shape& shape) {
  const auto edges = directed_edges(shape);
  for (const auto& [edge, count] : edges) {
    if (count != 1 || !edges.contains({edge[1], edge[0]})) return false;
  }
  return true;
}

}  // namespace selvage::sim::testbed
