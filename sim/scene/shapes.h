// Triangulated surfaces that scenes name instead of a mesh file, in their local frame. Faces are counter-clockwise
// seen from outside (closed shapes) or from +z (sheets).
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "io/mesh_data.h"
#include "kernel/types.h"

namespace selvage::sim {

struct Shape {
  Positions x;              ///< #V by 3, m
  io::Triangles triangles;  ///< #F by 3
  std::string remark = {};  ///< for a person, where its file was not taken as it stands
};

/// #V: 1 where a face names the vertex.
[[nodiscard]] std::vector<std::uint8_t> vertices_in_faces(const io::Triangles& triangles, std::size_t vertex_count);

/// nx by ny vertices in the plane z = 0, centred at the origin; vertex (i, j) is number j * nx + i. Diagonals alternate
/// like a chessboard, so that no diagonal direction is stiffer than the other. REQUIRES nx, ny >= 2.
[[nodiscard]] Shape make_sheet(std::int32_t nx, std::int32_t ny, double width_m, double height_m);

/// An icosahedron whose faces are split into four `subdivisions` times and pushed onto the sphere:
/// 10 * 4^n + 2 vertices, 20 * 4^n faces.
[[nodiscard]] Shape make_sphere(double radius_m, std::int32_t subdivisions);

/// A sphere of diameter 1 stretched to size_m along the axes, centred at the origin.
[[nodiscard]] Shape make_ellipsoid(const Vec3& size_m, std::int32_t subdivisions);

/// A limb: two spheres, about the origin and about end_m, and the cone that touches both; closed. The vertices lie on
/// it, `segments` around. REQUIRES |end_m| > |radius_m - end_radius_m|: neither sphere holds the other; segments >= 3.
[[nodiscard]] Shape make_capsule(const Vec3& end_m, double radius_m, double end_radius_m, std::int32_t segments);

/// Axis-aligned box centred at the origin; every side has cells by cells squares, edges and corners are shared.
[[nodiscard]] Shape make_box(const Vec3& size_m, std::int32_t cells);

}  // namespace selvage::sim
