#include "sim/scene/shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <vector>

#include <Eigen/Geometry>

#include "kernel/assert.h"

namespace selvage::sim {
namespace {

using Triangle = std::array<std::int32_t, 3>;

Positions to_positions(const std::vector<Vec3>& points) {
  Positions x(static_cast<Eigen::Index>(points.size()), 3);
  for (std::size_t i = 0; i < points.size(); ++i) x.row(static_cast<Eigen::Index>(i)) = points[i].transpose();
  return x;
}

// The corners in counter-clockwise order; `flip` chooses which diagonal splits the square.
void add_square(const std::array<std::int32_t, 4>& corner, bool flip, io::Triangles& triangles) {
  if (flip) {
    triangles.push_back({corner[0], corner[1], corner[3]});
    triangles.push_back({corner[1], corner[2], corner[3]});
  } else {
    triangles.push_back({corner[0], corner[1], corner[2]});
    triangles.push_back({corner[0], corner[2], corner[3]});
  }
}

// Vertices of a shape that is stitched from pieces: the same lattice point is the same vertex.
class LatticeVertices {
 public:
  std::int32_t at(const std::array<std::int32_t, 3>& cell) {
    const auto [found, added] = ids_.try_emplace(cell, static_cast<std::int32_t>(cells_.size()));
    if (added) cells_.push_back(cell);
    return found->second;
  }
  [[nodiscard]] const std::vector<std::array<std::int32_t, 3>>& cells() const { return cells_; }

 private:
  std::map<std::array<std::int32_t, 3>, std::int32_t> ids_;
  std::vector<std::array<std::int32_t, 3>> cells_;
};

}  // namespace

std::vector<std::uint8_t> vertices_in_faces(const io::Triangles& triangles, std::size_t vertex_count) {
  std::vector<std::uint8_t> result(vertex_count, 0);
  for (const auto& triangle : triangles) {
    for (const VertexId vertex : triangle) result[static_cast<std::size_t>(vertex)] = 1;
  }
  return result;
}

Shape make_sheet(std::int32_t nx, std::int32_t ny, double width_m, double height_m) {
  SELVAGE_ASSERT(nx >= 2 && ny >= 2);
  Shape sheet;
  sheet.x.resize(Eigen::Index{nx} * ny, 3);
  for (std::int32_t j = 0; j < ny; ++j) {
    for (std::int32_t i = 0; i < nx; ++i) {
      sheet.x.row(Eigen::Index{j} * nx + i) << (double(i) / (nx - 1) - 0.5) * width_m,
          (double(j) / (ny - 1) - 0.5) * height_m, 0.0;
    }
  }
  for (std::int32_t j = 0; j + 1 < ny; ++j) {
    for (std::int32_t i = 0; i + 1 < nx; ++i) {
      const std::int32_t a = j * nx + i;
      add_square({a, a + 1, a + nx + 1, a + nx}, (i + j) % 2 == 1, sheet.triangles);
    }
  }
  return sheet;
}

Shape make_sphere(double radius_m, std::int32_t subdivisions) {
  const double golden = (1 + std::sqrt(5.0)) / 2;  // the icosahedron's corners are (0, +-1, +-golden) and its rotations
  std::vector<Vec3> points = {{-1, golden, 0}, {1, golden, 0}, {-1, -golden, 0}, {1, -golden, 0},
                              {0, -1, golden}, {0, 1, golden}, {0, -1, -golden}, {0, 1, -golden},
                              {golden, 0, -1}, {golden, 0, 1}, {-golden, 0, -1}, {-golden, 0, 1}};
  for (Vec3& point : points) point *= radius_m / point.norm();
  io::Triangles triangles = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                             {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                             {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  for (std::int32_t level = 0; level < subdivisions; ++level) {
    std::map<std::array<std::int32_t, 2>, std::int32_t> middle_of;
    const auto middle = [&](std::int32_t a, std::int32_t b) {
      const auto [found, added] =
          middle_of.try_emplace({std::min(a, b), std::max(a, b)}, static_cast<std::int32_t>(points.size()));
      if (added) {
        const Vec3 sum = points[static_cast<std::size_t>(a)] + points[static_cast<std::size_t>(b)];
        points.push_back(sum * (radius_m / sum.norm()));
      }
      return found->second;
    };
    io::Triangles finer;
    for (const Triangle& t : triangles) {
      const std::int32_t ab = middle(t[0], t[1]), bc = middle(t[1], t[2]), ca = middle(t[2], t[0]);
      finer.insert(finer.end(), {Triangle{t[0], ab, ca}, Triangle{t[1], bc, ab}, Triangle{t[2], ca, bc}, {ab, bc, ca}});
    }
    triangles = std::move(finer);
  }
  return {to_positions(points), std::move(triangles)};
}

Shape make_ellipsoid(const Vec3& size_m, std::int32_t subdivisions) {
  Shape ellipsoid = make_sphere(0.5, subdivisions);
  ellipsoid.x = ellipsoid.x * size_m.asDiagonal();
  return ellipsoid;
}

Shape make_capsule(const Vec3& end_m, double radius_m, double end_radius_m, std::int32_t segments) {
  const double length_m = end_m.norm();
  SELVAGE_ASSERT(segments >= 3 && length_m > std::abs(radius_m - end_radius_m));
  const double right_angle = std::numbers::pi / 2, segment_angle = 2 * std::numbers::pi / segments;
  // Cone and spheres share their tangent planes where the normal leaves the cross-section by this angle.
  const double tilt = std::asin((radius_m - end_radius_m) / length_m);
  struct Ring {
    double along_m, radius_m;
  };
  std::vector<Ring> rings;
  const auto add_arc = [&](double center_m, double sphere_m, double from, double to, bool last) {
    const auto count = std::max(1L, std::lround((to - from) / segment_angle));
    for (long n = last ? 0 : 1; n < count + (last ? 0 : 1); ++n) {  // without the pole at its outer end
      const double angle = from + (to - from) * double(n) / double(count);
      rings.push_back({center_m + sphere_m * std::sin(angle), sphere_m * std::cos(angle)});
    }
  };
  add_arc(0, radius_m, -right_angle, tilt, false);
  const Ring from = rings.back();
  const Ring to{length_m + end_radius_m * std::sin(tilt), end_radius_m * std::cos(tilt)};
  const auto cone_rows =
      std::max(1L, std::lround((to.along_m - from.along_m) / (segment_angle * (from.radius_m + to.radius_m) / 2)));
  for (long n = 1; n < cone_rows; ++n) {
    const double t = double(n) / double(cone_rows);
    rings.push_back({(1 - t) * from.along_m + t * to.along_m, (1 - t) * from.radius_m + t * to.radius_m});
  }
  add_arc(length_m, end_radius_m, tilt, right_angle, true);

  const Vec3 axis = end_m / length_m;
  const Vec3 across = axis.unitOrthogonal(), up = axis.cross(across);
  std::vector<Vec3> points = {-radius_m * axis, end_m + end_radius_m * axis};
  for (const Ring& ring : rings) {
    for (std::int32_t i = 0; i < segments; ++i) {
      points.push_back(ring.along_m * axis +
                       ring.radius_m * (std::cos(i * segment_angle) * across + std::sin(i * segment_angle) * up));
    }
  }
  const auto row_count = static_cast<std::int32_t>(rings.size());
  const auto vertex = [&](std::int32_t row, std::int32_t i) { return 2 + row * segments + i % segments; };
  io::Triangles triangles;
  for (std::int32_t i = 0; i < segments; ++i) {
    triangles.push_back({0, vertex(0, i + 1), vertex(0, i)});
    for (std::int32_t row = 0; row + 1 < row_count; ++row) {
      add_square({vertex(row, i), vertex(row, i + 1), vertex(row + 1, i + 1), vertex(row + 1, i)}, (row + i) % 2 == 1,
                 triangles);
    }
    triangles.push_back({1, vertex(row_count - 1, i), vertex(row_count - 1, i + 1)});
  }
  return {to_positions(points), std::move(triangles)};
}

Shape make_box(const Vec3& size_m, std::int32_t cells) {
  SELVAGE_ASSERT(cells >= 1);
  LatticeVertices vertices;
  io::Triangles triangles;
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;  // u x v points along +axis
    for (const bool upper : {false, true}) {
      const auto vertex = [&](std::int32_t i, std::int32_t j) {
        std::array<std::int32_t, 3> cell{};
        cell[static_cast<std::size_t>(axis)] = upper ? cells : 0;
        cell[static_cast<std::size_t>(u)] = i;
        cell[static_cast<std::size_t>(v)] = j;
        return vertices.at(cell);
      };
      for (std::int32_t j = 0; j < cells; ++j) {
        for (std::int32_t i = 0; i < cells; ++i) {
          const std::int32_t a = vertex(i, j), b = vertex(i + 1, j), c = vertex(i + 1, j + 1), d = vertex(i, j + 1);
          add_square(upper ? std::array{a, b, c, d} : std::array{a, d, c, b}, (i + j) % 2 == 1, triangles);
        }
      }
    }
  }
  Shape box;
  box.triangles = std::move(triangles);
  box.x.resize(static_cast<Eigen::Index>(vertices.cells().size()), 3);
  for (std::size_t n = 0; n < vertices.cells().size(); ++n) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto axis = static_cast<Eigen::Index>(k);
      box.x(static_cast<Eigen::Index>(n), axis) = (double(vertices.cells()[n][k]) / cells - 0.5) * size_m[axis];
    }
  }
  return box;
}

}  // namespace selvage::sim
