#include "sim/contact/straight_surface.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>
#include <utility>

#include <Eigen/Geometry>

#include "sim/base/points.h"

namespace selvage::sim {
namespace {

/// Cloth that slides at 3 m/s passes 10 cm in a step of a 30th of a second: 32 edges of 3 mm, which is what it is
/// thick.
constexpr int kMaxAhead = 32;

/// Normals of faces around a vertex that are tried: of a cube's corner cut into any faces there are three, and a hub of
/// hundreds of faces is asked in linear time.
constexpr std::size_t kMaxPlanes = 4;

/// Faces around a vertex on a line: all pairs of its neighbours are tried, which of the hub of a cone of hundreds of
/// faces would take longer than all else of a contact, and a ridge has six or so.
constexpr std::size_t kMaxOnLine = 64;

Vec3 way(const Positions& V, VertexId from, VertexId to) { return (V.row(to) - V.row(from)).stableNormalized(); }

double length(const Positions& V, VertexId from, VertexId to) { return (V.row(to) - V.row(from)).stableNorm(); }

double height_over(const Positions& V, VertexId a, VertexId b, VertexId third) {
  return way(V, a, b).cross(V.row(third) - V.row(a)).stableNorm();
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

double StraightFeature::extent_share(PairKind kind, const std::array<double, 4>& weights) const {
  if (kind == PairKind::kVf || part(kind, weights) != kWithin) return 1;
  return std::min(std::abs(weights[first]), std::abs(weights[first + 1U]));
}

Across across(const StraightSurface& surface, double extent_share, const Vec3& direction, const Vec3& unit,
              double distance) {
  if (surface.kind == StraightSurface::Kind::kCorner) return {unit};
  const double along_direction = unit.dot(direction);
  const Vec3 part = along_direction * direction, rest = unit - part;
  const bool is_line = surface.kind == StraightSurface::Kind::kLine;
  const Vec3 &along = is_line ? part : rest, &left = is_line ? rest : part;
  const double extent = extent_share * surface.extents_m[along_direction > 0 ? 1 : 0];
  const double size = left.norm();
  if (!(size > kLeastAcross)) return {unit, true};
  return {left / size, distance * along.norm() > extent + kStraight * distance};
}

void StraightSurfaces::start(const Positions& V) {
  if (V.rows() > 0 && same_bits(V, V_)) return;
  V_.resize(0, 3);  // if an exception ends this, what is known is of no positions
  std::ranges::fill(is_known_, kNo);
  V_ = V;
}

StraightFeature StraightSurfaces::of(PairKind kind, const std::array<VertexId, 4>& vertices,
                                     const std::vector<std::uint8_t>& is_cloth) const {
  const auto is_body = [&](std::size_t k) { return is_cloth[static_cast<std::size_t>(vertices[k])] == 0; };
  if (kind == PairKind::kVf) return is_body(0) ? StraightFeature{{at(vertices[0])}} : StraightFeature{};
  const std::uint8_t first = is_body(0) ? 0 : 2;
  if (!is_body(first)) return {};
  const VertexId a = vertices[first], b = vertices[first + 1U];
  return {{within(a, b), at(a), at(b)}, first};
}

StraightSurface StraightSurfaces::at(VertexId vertex) const {
  const auto at = static_cast<std::size_t>(vertex);
  const std::atomic_ref is_known(is_known_[at]);
  if (is_known.load(std::memory_order_acquire) == kYes) return at_[at];
  const StraightSurface found = find_at(vertex);
  std::uint8_t expected = kNo;
  if (is_known.compare_exchange_strong(expected, kBeingFound, std::memory_order_relaxed)) {
    at_[at] = found;
    is_known.store(kYes, std::memory_order_release);
  }
  return found;
}

StraightSurface StraightSurfaces::find_at(VertexId vertex) const {
  Fan fan;
  for (const FaceId face : faces_.of(vertex)) {
    const auto& [a, b, c] = mesh_.faces[static_cast<std::size_t>(face)];
    const std::array<VertexId, 2> ends{a == vertex ? b : a, c == vertex ? b : c};
    fan.push_back({ends, {way(V_, vertex, ends[0]), way(V_, vertex, ends[1])}});
  }
  const StraightSurface plane = plane_around(vertex, fan);
  return plane.kind == StraightSurface::Kind::kPlane ? plane : line_through(vertex, fan);
}

double StraightSurfaces::Sector::sine() const { return ways[0].cross(ways[1]).norm(); }

/// Whether the faces, which lie in the plane, leave no gap around their common vertex.
bool StraightSurfaces::surrounds(const Fan& faces, const Vec3& normal) {
  constexpr double kTurn = 2 * std::numbers::pi;
  const Vec3 x = normal.unitOrthogonal(), y = normal.cross(x);
  std::vector<std::pair<double, double>> spans;  // first and last angles
  for (const Sector& face : faces) {
    std::array<double, 2> angles{};
    for (const std::size_t k : {0U, 1U}) angles[k] = std::atan2(face.ways[k].dot(y), face.ways[k].dot(x));
    const double turn = std::remainder(angles[1] - angles[0], kTurn);
    const double first = turn > 0 ? angles[0] : angles[1];
    spans.emplace_back(first, first + std::abs(turn));
  }
  if (spans.empty()) return false;
  std::ranges::sort(spans);
  double till = spans.front().first;
  for (const auto& [first, last] : spans) {
    if (first > till + kStraight) return false;
    till = std::max(till, last);
  }
  return till >= spans.front().first + kTurn - kStraight;
}

/// That of faces which surround the vertex; others may leave it, as ribs below a plate do. It goes as far as to the
/// nearest edge around it.
StraightSurface StraightSurfaces::plane_around(VertexId vertex, const Fan& fan) const {
  std::vector<Vec3> tried;
  for (const Sector& face : fan) {
    const Vec3 normal = face.ways[0].cross(face.ways[1]).stableNormalized();
    const auto was_tried = [&](const Vec3& other) { return other.cross(normal).norm() < kStraight; };
    if (normal.isZero(0) || std::ranges::any_of(tried, was_tried)) continue;
    if (tried.size() == kMaxPlanes) break;
    tried.push_back(normal);
    Fan in_plane;
    std::ranges::copy_if(fan, std::back_inserter(in_plane), [&](const Sector& other) {
      const auto lies_in_it = [&](const Vec3& way) { return std::abs(way.dot(normal)) < kStraight; };
      return other.sine() > 0 && std::ranges::all_of(other.ways, lies_in_it);
    });
    if (!surrounds(in_plane, normal)) continue;
    const Sector& widest = *std::ranges::max_element(in_plane, {}, &Sector::sine);
    double extent_m = std::numeric_limits<double>::infinity();
    for (const Sector& each : in_plane) {
      extent_m = std::min(extent_m, height_over(V_, each.ends[0], each.ends[1], vertex));
    }
    return {StraightSurface::Kind::kPlane, {vertex, widest.ends[0], vertex, widest.ends[1]}, {extent_m, extent_m}};
  }
  return {};
}

/// Through two neighbours on opposite sides, if all faces go along it.
StraightSurface StraightSurfaces::line_through(VertexId vertex, const Fan& fan) const {
  if (fan.size() > kMaxOnLine) return {};
  for (std::size_t j = 0; j < 2 * fan.size(); ++j) {
    const Vec3& there = fan[j / 2].ways[j % 2];
    for (std::size_t i = 0; i < j; ++i) {
      if (!((fan[i / 2].ways[i % 2] + there).squaredNorm() < kStraight * kStraight)) continue;
      const auto goes_along = [&](const Sector& face) {
        return std::abs(there.dot(face.ways[0].cross(face.ways[1]))) < kStraight;
      };
      if (!std::ranges::all_of(fan, goes_along)) continue;
      const VertexId first = fan[i / 2].ends[i % 2], second = fan[j / 2].ends[j % 2];
      return {StraightSurface::Kind::kLine,
              {first, second, 0, 0},
              {line_extent(vertex, first), line_extent(vertex, second)}};
    }
  }
  return {};
}

/// As long as there is a neighbour straight ahead.
double StraightSurfaces::line_extent(VertexId from, VertexId to) const {
  const Vec3 ahead = way(V_, from, to);
  VertexId before = from, end = to;
  for (int edges = 1; edges < kMaxAhead; ++edges) {
    VertexId next = before;
    for (const FaceId face : faces_.of(end)) {
      for (const VertexId corner : mesh_.faces[static_cast<std::size_t>(face)]) {
        if (corner != end && (way(V_, end, corner) - ahead).squaredNorm() < kStraight * kStraight) next = corner;
      }
    }
    if (next == before) break;
    before = std::exchange(end, next);
  }
  return length(V_, from, end);
}

/// In the plane of two of its faces, or else a corner: nearest points within an edge are across it.
StraightSurface StraightSurfaces::within(VertexId a, VertexId b) const {
  const Vec3 edge = way(V_, a, b);
  if (edge.isZero(0)) return {};
  std::vector<std::pair<VertexId, Vec3>> beside;  // corners, and the ways to them across the edge
  for (const FaceId face : faces_.of_either(a, b)) {
    const auto corner = corner_across(mesh_.faces[static_cast<std::size_t>(face)], a, b);
    if (!corner) continue;
    const Vec3 there = way(V_, a, *corner);
    const Vec3 across_edge = (there - there.dot(edge) * edge).stableNormalized();
    if (across_edge.isZero(0)) continue;
    for (const auto& [other, across_other] : beside) {
      if (!((across_edge + across_other).squaredNorm() < kStraight * kStraight)) continue;
      const double extent_m = std::min(extent_beside(V_, a, b, *corner), extent_beside(V_, a, b, other));
      return {StraightSurface::Kind::kPlane, {a, b, a, *corner}, {extent_m, extent_m}};
    }
    beside.emplace_back(*corner, across_edge);
  }
  return {};
}

}  // namespace selvage::sim
