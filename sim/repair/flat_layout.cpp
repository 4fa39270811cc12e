#include "sim/repair/flat_layout.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <numbers>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

namespace selvage::sim {
namespace {

// Of the mean of a border's edges, for each: chosen. Folded between two rows, a sheet has edges without length, whose
// ends stayed at one place.
constexpr double kLeastEdge = 0.125;

using PlanePoint = Eigen::Vector2d;

struct LayoutPlane {
  Vec3 middle, u, w;  // two unit vectors at right angles

  [[nodiscard]] PlanePoint coordinates(const Vec3& point) const {
    return {(point - middle).dot(u), (point - middle).dot(w)};
  }
  [[nodiscard]] Vec3 point(const PlanePoint& at) const { return middle + at.x() * u + at.y() * w; }
};

/// By vertex of the part, in its order: the neighbours along edges of one face. None with an edge of three faces, or
/// without a border.
std::optional<Neighbours> border_neighbours(const Mesh& mesh, const Region& part) {
  std::vector<int> faces_at(mesh.edges.size(), 0);
  for (const auto& edges : mesh.face_edges) {
    for (const EdgeId e : edges) ++faces_at[static_cast<std::size_t>(e)];
  }
  Neighbours along(part.size());
  bool has_border = false;
  for (std::size_t e = 0; e < mesh.edges.size(); ++e) {
    const auto [a, b] = mesh.edges[e];
    const std::size_t i = index_in(part, a);
    if (i == part.size()) continue;
    if (faces_at[e] > 2) return std::nullopt;
    if (faces_at[e] != 1) continue;
    along[i].push_back(b);
    along[index_in(part, b)].push_back(a);
    has_border = true;
  }
  if (!has_border) return std::nullopt;
  return along;
}

/// From a vertex along the border until it comes back. Empty where it meets a vertex that the border visits twice.
std::vector<VertexId> border_loop(const Region& part, const Neighbours& along, VertexId start) {
  std::vector<VertexId> loop;
  VertexId before = -1;
  for (VertexId v = start; v != start || loop.empty();) {
    const auto& around = along[index_in(part, v)];
    if (around.size() != 2) return {};
    loop.push_back(v);
    before = std::exchange(v, around[around[0] == before ? 1 : 0]);
  }
  return loop;
}

double edge_length(const std::vector<VertexId>& loop, std::size_t i, const Positions& V) {
  return (V.row(loop[(i + 1) % loop.size()]) - V.row(loop[i])).stableNorm();
}

double loop_length(const std::vector<VertexId>& loop, const Positions& V) {
  double length = 0;
  for (std::size_t i = 0; i < loop.size(); ++i) length += edge_length(loop, i, V);
  return length;
}

std::vector<VertexId> longest_loop(const Region& part, const Neighbours& along, const Positions& V) {
  std::vector<VertexId> longest;
  std::vector<std::uint8_t> is_seen(part.size(), 0);
  for (std::size_t i = 0; i < part.size(); ++i) {
    if (is_seen[i] != 0) continue;
    std::vector<VertexId> loop = border_loop(part, along, part[i]);
    for (const VertexId v : loop) is_seen[index_in(part, v)] = 1;
    if (loop_length(loop, V) > loop_length(longest, V)) longest = std::move(loop);
  }
  return longest;
}

LayoutPlane plane_of(const Region& part, const Positions& x) {
  LayoutPlane plane{Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
  for (const VertexId v : part) plane.middle += Vec3(x.row(v)) / static_cast<double>(part.size());
  const auto keep_longer = [](const Vec3& candidate, Vec3& longest) {
    if (candidate.stableNorm() > longest.stableNorm()) longest = candidate;
  };
  for (const VertexId v : part) keep_longer(Vec3(x.row(v)) - plane.middle, plane.u);
  plane.u = plane.u.isZero(0) ? Vec3::UnitX() : Vec3(plane.u.stableNormalized());
  for (const VertexId v : part) {
    const Vec3 there = Vec3(x.row(v)) - plane.middle;
    keep_longer(there - there.dot(plane.u) * plane.u, plane.w);
  }
  // Once more at right angles: what is left of a long vector is so to the rounding of that one alone.
  plane.w -= plane.w.dot(plane.u) * plane.u;
  plane.w = plane.w.isZero(0) ? Vec3(plane.u.unitOrthogonal()) : Vec3(plane.w.stableNormalized());
  return plane;
}

/// Of the unit circle, in turns of [0, 1]: evenly around the square that stands on a corner, and out from there, which
/// is as even as needed, by a factor of two, and takes a square root alone.
PlanePoint on_circle(double turn) {
  const std::array<PlanePoint, 5> corners{PlanePoint(1, 0), PlanePoint(0, 1), PlanePoint(-1, 0), PlanePoint(0, -1),
                                          PlanePoint(1, 0)};
  const std::size_t side = std::min<std::size_t>(static_cast<std::size_t>(4 * turn), 3);
  const double along = 4 * turn - static_cast<double>(side);
  return ((1 - along) * corners[side] + along * corners[side + 1]).normalized();
}

/// a times b, as complex numbers.
PlanePoint turned(const PlanePoint& a, const PlanePoint& b) {
  return {a.x() * b.x() - a.y() * b.y(), a.x() * b.y() + a.y() * b.x()};
}
PlanePoint mirrored(const PlanePoint& a) { return {a.x(), -a.y()}; }

/// The loop on a circle of its length. The sum of squares of ways from `here` is least where the sum of here times
/// circle, as complex numbers and the latter mirrored, is turned to a positive number; of the two senses, the one with
/// the larger sum is nearer.
std::vector<PlanePoint> border_circle(const std::vector<VertexId>& loop, const Positions& V, const Positions& x,
                                      const LayoutPlane& plane) {
  const double length = loop_length(loop, V), least = kLeastEdge * length / static_cast<double>(loop.size());
  const auto room = [&](std::size_t i) { return std::max(edge_length(loop, i, V), least); };
  double all_room = 0;
  for (std::size_t i = 0; i < loop.size(); ++i) all_room += room(i);
  std::vector<PlanePoint> circle;
  std::array<PlanePoint, 2> sums{PlanePoint::Zero(), PlanePoint::Zero()};  // as it is, mirrored
  double way = 0;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    circle.push_back(on_circle(way / all_room));
    const PlanePoint here = plane.coordinates(x.row(loop[i]));
    sums[0] += turned(here, mirrored(circle[i]));
    sums[1] += turned(here, circle[i]);
    way += room(i);
  }
  const bool is_mirrored = sums[1].stableNorm() > sums[0].stableNorm();
  const PlanePoint& sum = sums[is_mirrored ? 1 : 0];
  const PlanePoint turn = sum.isZero(0) ? PlanePoint(1, 0) : PlanePoint(sum.stableNormalized());
  const double radius = length / (2 * std::numbers::pi);
  for (PlanePoint& p : circle) p = radius * turned(turn, is_mirrored ? mirrored(p) : p);
  return circle;
}

}  // namespace

std::optional<FlatLayout> flat_layout(const Mesh& mesh, const Neighbours& neighbours, const Region& part,
                                      const Positions& V, const Positions& x) {
  const std::optional<Neighbours> along = border_neighbours(mesh, part);
  if (!along) return std::nullopt;
  const std::vector<VertexId> loop = longest_loop(part, *along, V);
  if (loop.empty()) return std::nullopt;
  const LayoutPlane plane = plane_of(part, x);
  const std::vector<PlanePoint> circle = border_circle(loop, V, x, plane);
  Positions all = x;
  Region inner = part;
  for (std::size_t i = 0; i < loop.size(); ++i) all.row(loop[i]) = plane.point(circle[i]);
  Region border = loop;
  std::ranges::sort(border);
  std::erase_if(inner, [&](VertexId v) { return index_in(border, v) < border.size(); });
  if (!inner.empty()) {
    const std::optional<Positions> means = spanning_membrane(neighbours, inner, all);
    if (!means) return std::nullopt;
    for (std::size_t i = 0; i < inner.size(); ++i) all.row(inner[i]) = means->row(static_cast<Eigen::Index>(i));
  }
  FlatLayout flat{part, Positions(static_cast<Eigen::Index>(part.size()), 3), plane.u.cross(plane.w)};
  for (std::size_t i = 0; i < part.size(); ++i) flat.x.row(static_cast<Eigen::Index>(i)) = all.row(part[i]);
  return flat;
}

}  // namespace selvage::sim
