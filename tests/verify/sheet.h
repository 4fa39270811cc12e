// A clean test surface and what is planted into it. Coordinates are small dyadic numbers, so that points can be put
// exactly onto faces.
#pragma once

#include <cstdint>
#include <vector>

#include "io/mesh_data.h"
#include "verify/check.h"

namespace selvage::testing {

/// A wavy height field of 2 n^2 faces, spacing 1: embedded, because x and y are.
inline io::MeshData sheet(std::int32_t n) {
  io::MeshData mesh;
  for (std::int32_t j = 0; j <= n; ++j) {
    for (std::int32_t i = 0; i <= n; ++i) {
      const double height = static_cast<double>((7 * i * i + 3 * i * j + 5 * j) % 16) / 32;
      mesh.points.push_back({static_cast<double>(i), static_cast<double>(j), height});
    }
  }
  for (std::int32_t j = 0; j < n; ++j) {
    for (std::int32_t i = 0; i < n; ++i) {
      const std::int32_t a = j * (n + 1) + i, b = a + 1, c = a + n + 1, d = c + 1;
      mesh.triangles.push_back({a, b, d});
      mesh.triangles.push_back({a, d, c});
    }
  }
  return mesh;
}

/// weights / 4 of the corners of a face, plus a lift along z: exact for weights that sum to 4.
inline verify::Point point_on(const io::MeshData& mesh, std::size_t face, std::array<int, 3> weights, double lift = 0) {
  verify::Point p{0, 0, lift};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      p[k] += weights[i] * mesh.points[static_cast<std::size_t>(mesh.triangles[face][i])][k] / 4;
    }
  }
  return p;
}

inline std::int32_t add_vertex(io::MeshData& mesh, const verify::Point& p) {
  mesh.points.push_back(p);
  return static_cast<std::int32_t>(mesh.points.size()) - 1;
}

/// The corners of two faces whose nearest are {0, height, 0} and {x, height, y}.
inline std::vector<verify::Point> two_faces_apart(double x, double y, double height) {
  return {{0, height, 0}, {-1, height + 1, 0},    {-1, height - 1, 0},
          {x, height, y}, {x + 1, height + 1, y}, {x + 1, height - 1, y}};
}

inline verify::Surface surface(const io::MeshData& mesh) { return {mesh.triangles, {}}; }

}  // namespace selvage::testing
