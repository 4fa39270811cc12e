#include "sim/contact/straight_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

namespace selvage::sim {
namespace {

/// The sine of the angle between two lines that span a plane.
constexpr double kSpanning = 0.1;

Vec3 way(const Positions& V, VertexId from, VertexId to) { return (V.row(to) - V.row(from)).stableNormalized(); }

double length(const Positions& V, VertexId from, VertexId to) { return (V.row(to) - V.row(from)).stableNorm(); }

double height_over(const Positions& V, VertexId a, VertexId b, VertexId third) {
  return way(V, a, b).cross(V.row(third) - V.row(a)).norm();
}

/// How far a face goes on beside an edge of it, over the weight of the nearer end of where on the edge that is: its
/// height if that stands on the edge, and else what of the height is left where it leaves the end.
double extent_beside(const Positions& V, VertexId a, VertexId b, VertexId third) {
  const double foot = way(V, a, b).dot(V.row(third) - V.row(a)) / length(V, a, b);
  return height_over(V, a, b, third) / std::max({foot, 1 - foot, 1.0});
}

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

double StraightFeature::extent_m(PairKind kind, const std::array<double, 4>& weights) const {
  const Part on = part(kind, weights);
  const bool is_within_edge = kind == PairKind::kEe && on == kWithin;
  const double share = is_within_edge ? std::min(std::abs(weights[first]), std::abs(weights[first + 1U])) : 1;
  return share * parts.at(on).extent_m;
}

Vec3 along(StraightSurface::Kind kind, const Vec3& direction, const Vec3& vector) {
  if (kind == StraightSurface::Kind::kCorner) return Vec3::Zero();
  const Vec3 part = vector.dot(direction) * direction;
  return kind == StraightSurface::Kind::kLine ? part : Vec3(vector - part);
}

Vec3 across(StraightSurface::Kind kind, const Vec3& direction, const Vec3& unit) {
  if (kind == StraightSurface::Kind::kCorner) return unit;
  const Vec3 left = unit - along(kind, direction, unit);
  const double size = left.norm();
  return size > kLeastAcross ? Vec3(left / size) : unit;
}

bool is_over(double distance, const Vec3& part, double extent_m) {
  return distance * part.norm() <= extent_m + kStraight * distance;
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

/// Through two neighbours on opposite sides, and two more. A line goes as far as to the nearer neighbour, a plane as
/// far as to the nearest edge around the vertex.
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
          const double extent_m = std::min(length(V, vertex, neighbours[i]), length(V, vertex, corner));
          result = {StraightSurface::Kind::kLine, {neighbours[i], corner, 0, 0}, extent_m};
          line = there;
        } else if (line.cross(there).norm() > kSpanning) {
          const std::array<VertexId, 4> ends{result.ends[0], result.ends[1], neighbours[i], corner};
          return {StraightSurface::Kind::kPlane, ends, extent_around(vertex, V)};
        }
      }
      neighbours.push_back(corner);
      ways.push_back(there);
    }
  }
  return result;
}

double StraightSurfaces::extent_around(VertexId vertex, const Positions& V) const {
  double result = std::numeric_limits<double>::infinity();
  for (const FaceId face : faces_.of(vertex)) {
    const auto& [a, b, c] = mesh_.faces[static_cast<std::size_t>(face)];
    const std::array<VertexId, 2> edge{a == vertex ? b : a, c == vertex ? b : c};
    result = std::min(result, height_over(V, edge[0], edge[1], vertex));
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
  if (one.isZero(0) || !((one - other).squaredNorm() < kStraight * kStraight)) return {};
  const double extent_m = std::min(extent_beside(V, a, b, opposite[0]), extent_beside(V, a, b, opposite[1]));
  return {StraightSurface::Kind::kPlane, {a, b, opposite[0], opposite[1]}, extent_m};
}

}  // namespace selvage::sim
