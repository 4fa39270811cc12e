#include "sim/cloth.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>

#include <Eigen/Geometry>

namespace selvage::sim {
namespace {

class SpringBuilder {
 public:
  SpringBuilder(const ClothSpec& spec, const Shape& rest, const std::vector<double>& mass_kg)
      : spec_(spec), rest_(rest), mass_kg_(mass_kg) {}

  void add(SpringKind kind, VertexId a, VertexId b) {
    Spring spring{a, b, kind, (rest_.x.row(b) - rest_.x.row(a)).norm(), stiffness(kind), 0};
    if (spring.stiffness_n_m == 0) return;
    const double mass_a = mass_kg_[static_cast<std::size_t>(a)], mass_b = mass_kg_[static_cast<std::size_t>(b)];
    const double reduced_mass = mass_a * mass_b / (mass_a + mass_b);
    spring.damping_n_s_m = spec_.damping_ratio * 2 * std::sqrt(spring.stiffness_n_m * reduced_mass);
    springs_.push_back(spring);
  }
  std::vector<Spring> take() { return std::move(springs_); }

 private:
  [[nodiscard]] double stiffness(SpringKind kind) const {
    switch (kind) {
      case SpringKind::kStructural:
        return spec_.stretch_n_m;
      case SpringKind::kShear:
        return spec_.shear_n_m;
      case SpringKind::kBending:
        return spec_.bend_n_m;
    }
    return 0;
  }

  const ClothSpec& spec_;
  const Shape& rest_;
  const std::vector<double>& mass_kg_;
  std::vector<Spring> springs_;
};

void add_sheet_springs(const SheetSpec& sheet, SpringBuilder& builder) {
  const std::int32_t nx = sheet.nx, ny = sheet.ny;
  for (std::int32_t j = 0; j < ny; ++j) {
    for (std::int32_t i = 0; i < nx; ++i) {
      const VertexId a = j * nx + i;
      if (i + 1 < nx) builder.add(SpringKind::kStructural, a, a + 1);
      if (j + 1 < ny) builder.add(SpringKind::kStructural, a, a + nx);
      if (i + 1 < nx && j + 1 < ny) {
        builder.add(SpringKind::kShear, a, a + nx + 1);
        builder.add(SpringKind::kShear, a + 1, a + nx);
      }
      if (i + 2 < nx) builder.add(SpringKind::kBending, a, a + 2);
      if (j + 2 < ny) builder.add(SpringKind::kBending, a, a + 2 * nx);
    }
  }
}

/// Every edge with the third vertices of its faces.
std::map<std::array<VertexId, 2>, std::vector<VertexId>> edges_of(const io::Triangles& triangles) {
  std::map<std::array<VertexId, 2>, std::vector<VertexId>> opposite_of;
  for (const auto& t : triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const VertexId a = t[(k + 1) % 3], b = t[(k + 2) % 3];
      opposite_of[{std::min(a, b), std::max(a, b)}].push_back(t[k]);
    }
  }
  return opposite_of;
}
bool is_hinge(const std::vector<VertexId>& opposite) { return opposite.size() == 2 && opposite[0] != opposite[1]; }

void add_mesh_springs(const io::Triangles& triangles, SpringBuilder& builder) {
  for (const auto& [edge, opposite] : edges_of(triangles)) {
    builder.add(SpringKind::kStructural, edge[0], edge[1]);
    if (is_hinge(opposite)) builder.add(SpringKind::kBending, opposite[0], opposite[1]);
  }
}

// Stabilizer::straight_m, as a part of what a stabiliser spans: far above what rounding in double precision bends a
// flat sheet by (6e-8 of it for 64 x 64 vertices; 5 times it in float32), far below what is seen.
constexpr double kStraight = 1e-6;

// With the two faces unfolded into one plane, the line between c and d crosses the line of a and b: the two material
// points are where it does. Nothing for faces without area.
std::optional<Stabilizer> hinge_stabilizer(const Positions& x, const std::array<VertexId, 2>& edge,
                                           const std::vector<VertexId>& opposite) {
  const Vec3 a = x.row(edge[0]), ab = Vec3(x.row(edge[1])) - a;
  const double length = ab.norm();
  if (!(length > 0)) return std::nullopt;
  std::array<double, 2> along{}, height{};
  for (std::size_t k = 0; k < 2; ++k) {
    const Vec3 p = Vec3(x.row(opposite[k])) - a;
    along[k] = p.dot(ab) / length;
    height[k] = p.cross(ab).norm() / length;
  }
  if (!(height[0] > 0) || !(height[1] > 0)) return std::nullopt;
  const double t = height[0] / (height[0] + height[1]);
  const double s = (along[0] + t * (along[1] - along[0])) / length;
  return Stabilizer{
      {edge[0], edge[1], opposite[0], opposite[1]}, {1 - s, s, t - 1, -t}, 0, 0, kStraight * (height[0] + height[1])};
}

// Those along x, then those along y: the lanes of a block are neighbours then (sim/springs/stabilizer_lanes.h).
std::vector<Stabilizer> sheet_stabilizers(const SheetSpec& sheet) {
  std::vector<Stabilizer> made;
  const std::int32_t nx = sheet.nx, ny = sheet.ny;
  const auto add = [&](VertexId middle, VertexId stride, double span_m) {
    made.push_back({{middle, middle - stride, middle + stride, 0}, {1, -0.5, -0.5, 0}, 0, 0, kStraight * span_m});
  };
  for (std::int32_t j = 0; j < ny; ++j) {
    for (std::int32_t i = 1; i + 1 < nx; ++i) add(j * nx + i, 1, 2 * sheet.width_m / (nx - 1));
  }
  for (std::int32_t j = 1; j + 1 < ny; ++j) {
    for (std::int32_t i = 0; i < nx; ++i) add(j * nx + i, nx, 2 * sheet.height_m / (ny - 1));
  }
  return made;
}

double area_m2(const Positions& x, const std::array<VertexId, 3>& t) {
  const Vec3 a = x.row(t[0]), b = x.row(t[1]), c = x.row(t[2]);
  return 0.5 * (b - a).cross(c - a).norm();
}

}  // namespace

std::vector<Spring> make_springs(const ClothSpec& spec, const Shape& rest, const std::vector<double>& mass_kg) {
  SpringBuilder builder(spec, rest, mass_kg);
  if (const auto* sheet = std::get_if<SheetSpec>(&spec.surface)) {
    add_sheet_springs(*sheet, builder);
  } else {
    add_mesh_springs(rest.triangles, builder);
  }
  return builder.take();
}

std::vector<Stabilizer> make_stabilizers(const ClothSpec& spec, const Shape& rest, const std::vector<double>& mass_kg) {
  std::vector<Stabilizer> made;
  if (spec.stabilize_n_m == 0) return made;
  if (const auto* sheet = std::get_if<SheetSpec>(&spec.surface)) {
    made = sheet_stabilizers(*sheet);
  } else {
    for (const auto& [edge, opposite] : edges_of(rest.triangles)) {
      if (!is_hinge(opposite)) continue;
      if (const auto hinge = hinge_stabilizer(rest.x, edge, opposite)) made.push_back(*hinge);
    }
  }
  for (Stabilizer& s : made) {
    double inverse_mass = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      inverse_mass += s.weights[i] * s.weights[i] / mass_kg[static_cast<std::size_t>(s.vertices[i])];
    }
    s.stiffness_n_m = spec.stabilize_n_m;
    s.damping_n_s_m = spec.damping_ratio * 2 * std::sqrt(spec.stabilize_n_m / inverse_mass);
  }
  return made;
}

std::vector<double> cloth_masses(const ClothSpec& spec, const Shape& rest) {
  std::vector<double> mass_kg(static_cast<std::size_t>(rest.x.rows()));
  double total_area_m2 = 0;
  for (const auto& t : rest.triangles) {
    const double area = area_m2(rest.x, t);
    total_area_m2 += area;
    for (const VertexId corner : t) mass_kg[static_cast<std::size_t>(corner)] += spec.density_kg_m2 * area / 3;
  }
  if (spec.masses == ClothSpec::Masses::kEqual) {
    // Vertices of no face weigh as much as the others, and take nothing from them.
    std::vector<std::uint8_t> has_face(mass_kg.size(), 0);
    for (const auto& t : rest.triangles) {
      for (const VertexId corner : t) has_face[static_cast<std::size_t>(corner)] = 1;
    }
    const auto sharing = std::ranges::count(has_face, std::uint8_t{1});
    if (sharing == 0) return mass_kg;
    std::ranges::fill(mass_kg, spec.density_kg_m2 * total_area_m2 / static_cast<double>(sharing));
  }
  return mass_kg;
}

}  // namespace selvage::sim
