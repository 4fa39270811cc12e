#include "sim/contact/straight_surface.h"

#include <algorithm>

#include <Eigen/Geometry>

namespace selvage::sim {
namespace {

/// The angle by which what is straight may bend. A vertex of a file in float32, a metre from the origin and a
/// centimetre from the next one, is off by 6e-6. Curved bodies are none of this: to go straight on for a step at 3 m/s
/// along a ball of 0.3 m would be off by 3 mm.
constexpr double kStraight = 1e-3;

/// The sine of the angle between two lines that span a plane.
constexpr double kSpanning = 0.1;

Vec3 way(const Positions& V, VertexId from, VertexId to) { return (V.row(to) - V.row(from)).stableNormalized(); }

}  // namespace

Vec3 StraightSurface::direction(const Positions& V) const {
  if (kind == Kind::kCorner) return Vec3::Zero();
  const Vec3 first = way(V, ends[0], ends[1]);
  return kind == Kind::kLine ? first : Vec3(first.cross(way(V, ends[2], ends[3])).stableNormalized());
}

bool StraightFeature::is_anywhere() const {
  return std::ranges::any_of(parts, [](auto& part) { return part.kind != StraightSurface::Kind::kCorner; });
}

StraightFeature::Part StraightFeature::part(PairKind kind, const std::array<double, 4>& weights) const {
  if (kind == PairKind::kVf) return kWithin;
  if (weights[first + 1U] == 0) return kFirstEnd;
  return weights[first] == 0 ? kSecondEnd : kWithin;
}

Vec3 across(StraightSurface::Kind kind, const Vec3& direction, const Vec3& unit) {
  if (kind == StraightSurface::Kind::kCorner) return unit;
  const Vec3 part = unit.dot(direction) * direction;
  const Vec3 left = kind == StraightSurface::Kind::kLine ? Vec3(unit - part) : part;
  const double size = left.norm();
  return size > kLeastAcross ? Vec3(left / size) : unit;
}

StraightFeature StraightSurfaces::of(PairKind kind, const std::array<VertexId, 4>& vertices, const Positions& V,
                                     const std::vector<std::uint8_t>& is_cloth) const {
  const auto is_body = [&](std::size_t k) { return is_cloth[static_cast<std::size_t>(vertices[k])] == 0; };
  if (kind == PairKind::kVf) return is_body(0) ? StraightFeature{{at(vertices[0], V)}} : StraightFeature{};
  const std::uint8_t first = is_body(0) ? 0 : 2;
  if (!is_body(first)) return {};
  const VertexId a = vertices[first], b = vertices[first + 1U];
  return {{within(a, b, V), at(a, V), at(b, V)}, first};
}

/// Through two neighbours on opposite sides, and two more.
StraightSurface StraightSurfaces::at(VertexId vertex, const Positions& V) const {
  StraightSurface result;
  Vec3 line = Vec3::Zero();
  std::vector<VertexId> neighbours;
  std::vector<Vec3> ways;
  for (const FaceId face : faces_.of(vertex)) {
    for (const VertexId corner : mesh_.faces[static_cast<std::size_t>(face)]) {
      if (corner == vertex || std::ranges::find(neighbours, corner) != neighbours.end()) continue;
      const Vec3 there = way(V, vertex, corner);
      for (std::size_t i = 0; i < neighbours.size(); ++i) {
        if (!((ways[i] + there).squaredNorm() < kStraight * kStraight)) continue;
        if (result.kind == StraightSurface::Kind::kCorner) {
          result = {StraightSurface::Kind::kLine, {neighbours[i], corner, 0, 0}};
          line = there;
        } else if (line.cross(there).norm() > kSpanning) {
          return {StraightSurface::Kind::kPlane, {result.ends[0], result.ends[1], neighbours[i], corner}};
        }
      }
      neighbours.push_back(corner);
      ways.push_back(there);
    }
  }
  return result;
}

/// In the plane of its two faces, or else a corner: nearest points within an edge are across it.
StraightSurface StraightSurfaces::within(VertexId a, VertexId b, const Positions& V) const {
  std::vector<VertexId> opposite;
  for (const FaceId face : faces_.of_either(a, b)) {
    const auto& corners = mesh_.faces[static_cast<std::size_t>(face)];
    const auto third = std::ranges::find_if(corners, [&](VertexId v) { return v != a && v != b; });
    const bool holds_both = std::ranges::count_if(corners, [&](VertexId v) { return v == a || v == b; }) == 2;
    if (holds_both) opposite.push_back(*third);
  }
  if (opposite.size() != 2) return {};
  const Vec3 edge = way(V, a, b);
  const Vec3 one = edge.cross(way(V, a, opposite[0])).stableNormalized();
  const Vec3 other = way(V, a, opposite[1]).cross(edge).stableNormalized();
  if (!((one - other).squaredNorm() < kStraight * kStraight)) return {};
  return {StraightSurface::Kind::kPlane, {a, b, opposite[0], opposite[1]}};
}

}  // namespace selvage::sim
