#include "io/format/polygon.h"

#include <algorithm>

namespace selvage::io {

std::string append_fan(std::vector<std::int32_t>& corners, MeshData& mesh) {
  Triangles& triangles = mesh.triangles;
  if (corners.size() < 3)
    return "a face has " + std::to_string(corners.size()) + (corners.size() == 1 ? " corner" : " corners") +
           "; give three or more";
  if (triangles.size() + corners.size() - 2 > kMaxElements) return "more than 2^31 - 1 triangles; split the mesh";
  const std::size_t before = triangles.size();
  for (std::size_t k = 1; k + 1 < corners.size(); ++k) triangles.push_back({corners[0], corners[k], corners[k + 1]});
  std::sort(corners.begin(), corners.end());
  if (std::adjacent_find(corners.begin(), corners.end()) == corners.end()) {
    if (corners.size() > 3) ++mesh.split_polygons;
    return {};
  }
  triangles.resize(before);
  return "a face names the same vertex twice; remove the face";
}

std::string split_remark(const std::string& source, std::int64_t split_polygons) {
  if (split_polygons == 0) return {};
  return source + ": " + std::to_string(split_polygons) + (split_polygons == 1 ? " face has" : " faces have") +
         " more corners than three and " + (split_polygons == 1 ? "is" : "are") +
         " split into triangles around the first; faces are numbered after that";
}

}  // namespace selvage::io
